#include "band/enclosed.h"

#include <gtest/gtest.h>

#include <set>

#include "evenmesh/error.h"
#include "geometry/primitives.h"
#include "sample/sample.h"

namespace evenmesh {
namespace {

SampleSet sampled(const Mesh& mesh, std::size_t resolution, ExecutionContext& context) {
  const Shape shape = shape_from_mesh(mesh, "solid");
  return sample_shape(shape, make_grid(shape.bounds, resolution), context);
}

/// Places of samples, model units.
std::set<std::array<double, 3>> places(const SampleSet& set) {
  std::set<std::array<double, 3>> all;
  for (const SampleBlock& block : set.blocks)
    for (std::uint32_t s = block.begin; s < block.end; ++s) {
      const Vec3 p = set.block_center(block) + Vec3{set.x[s], set.y[s], set.z[s]};
      all.insert({p.x, p.y, p.z});
    }
  return all;
}

TEST(NarrowGapsFilled, ASolidWithoutGapsStays) {
  ExecutionContext context(2);
  for (const Mesh& mesh : {make_icosphere(3), make_box({1, 0.8, 0.6})}) {
    const SampleSet solid = sampled(mesh, 60, context);
    EXPECT_EQ(places(narrow_gaps_filled(solid, 4, context)), places(solid));
  }
}

TEST(NarrowGapsFilled, ASlotIsFilledAndAWideOneIsNot) {
  ExecutionContext context(2), one(1);
  const double h = 2.0 / 80;
  for (const double width : {4 * h, 14 * h}) {
    const Mesh left = make_box_around({{0, 0, 0}, {0.8, 1, 2}});
    const SampleSet solid = sampled(merged(left, translated(left, {0.8 + width, 0, 0})), 80, context);
    const SampleSet filled = narrow_gaps_filled(solid, 4, context);
    EXPECT_EQ(filled.total_area < 0.9 * solid.total_area, width < 8 * h);
    if (width > 8 * h) {
      EXPECT_EQ(places(filled), places(solid));
    }
    const SampleSet again = narrow_gaps_filled(solid, 4, one);
    EXPECT_EQ(places(again), places(filled));
  }
}

TEST(NarrowGapsFilled, TakesBallsThatAShellCanReach) {
  ExecutionContext context(1);
  const SampleSet solid = sampled(make_icosphere(1), 20, context);
  EXPECT_THROW(narrow_gaps_filled(solid, 0, context), InvalidInput);
  EXPECT_THROW(narrow_gaps_filled(solid, 11, context), InvalidInput);
}

}  // namespace
}  // namespace evenmesh
