#include "topology/closing.h"

#include <gtest/gtest.h>

#include "evenmesh/shape.h"
#include "grid/sample_checks.h"
#include "grid/surface_components.h"
#include "sample/sample.h"
#include "topology/ambiguous_faces.h"

namespace evenmesh {
namespace {

const Box box{{-2, -2, -2}, {2, 2, 2}};

SampleSet sampled_on(const char* expression, std::size_t resolution = 40) {
  return sample_shape(shape_from_expression(expression, {}, box), make_grid(box, resolution));
}

TEST(FillGaps, LeavesConvexSolidsAlone) {
  evenmesh::ExecutionContext context(2);
  const SampleSet ball = sampled_on("r - 1");
  const FilledSolid made = fill_gaps(ball, std::vector<Ball>{{{1, 0, 0}, 0.6}, {{0, -1, 0}, 0.4}}, context);
  EXPECT_LT(made.points.size(), 3u);
  EXPECT_NEAR(made.samples.total_area, ball.total_area, 2e-3 * ball.total_area);
}

TEST(FillGaps, JoinsBodiesThatNearlyTouchAndNothingFarther) {
  evenmesh::ExecutionContext context(2);
  // Two boxes, a gap of 0.15 between them: one and a half grid spacings.
  const SampleSet boxes = sampled_on("max(abs(y) - 1, abs(z) - 1, abs(abs(x) - 0.7) - 0.625)");
  ASSERT_EQ(surface_components(boxes, context).area.size(), 2u);
  std::vector<Ball> places;
  for (double y = -1; y <= 1; y += 0.2)
    for (double z = -1; z <= 1; z += 0.2) places.push_back({{0, y, z}, 0.4});
  const FilledSolid made = fill_gaps(boxes, places, context);
  EXPECT_EQ(surface_components(made.samples, context).area.size(), 1u);
  EXPECT_NEAR(double(made.points.size()) * std::pow(made.samples.grid.spacing, 3), 0.15 * 4, 0.3);
  for (const SampleBlock& b : made.samples.blocks)
    for (std::uint32_t i = b.begin; i < b.end; ++i) {
      const Vec3 p = position(made.samples, b, i);
      EXPECT_LE(std::max({std::abs(p.x) - 1.325, std::abs(p.y) - 1, std::abs(p.z) - 1}), 0.06) << p.x << ' ' << p.y;
    }
}

TEST(FillGaps, MakesWallsOfOnePointPlain) {
  evenmesh::ExecutionContext context(2);
  // Across the grid: steps where the wall's points meet along edges only.
  const SampleSet wall = sampled_on("max(abs(x + 0.61*y + 0.37*z) - 0.05, r - 1.2)", 60);
  const std::size_t before = find_ambiguous_faces(wall, context).size();
  ASSERT_GT(before, 100u);
  const FilledSolid made = fill_gaps(wall, std::vector<Ball>{{{0, 0, 0}, 1.5}}, context);
  EXPECT_LT(find_ambiguous_faces(made.samples, context).size(), before / 4);
  EXPECT_GT(surface_components(made.samples, context).area.size(), 0u) << "walks every cube: they all close up";
}

TEST(FillGaps, SameBytesForAnyNumberOfThreads) {
  const SampleSet wall = sampled_on("max(abs(x + 0.61*y + 0.37*z) - 0.05, r - 1.2)", 60);
  evenmesh::ExecutionContext one(1), two(2);
  const std::vector<Ball> places{{{0, 0, 0}, 0.5}, {{0.2, -0.3, 0}, 0.3}};
  const SampleSet a = fill_gaps(wall, places, one).samples, b = fill_gaps(wall, places, two).samples;
  for_each_column([](const auto& u, const auto& v) { EXPECT_TRUE(same_bytes(u, v)); }, a, b);
}

}  // namespace
}  // namespace evenmesh
