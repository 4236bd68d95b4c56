#include "grid/surface_components.h"

#include "connect/connect_testing.h"
#include "grid/density.h"

namespace evenmesh {
namespace {

Mesh ball_with_small_components() {
  Mesh mesh = make_icosphere(3);
  for (const Vec3& at : {Vec3{1.3, 0, 0}, Vec3{0, -1.3, 0.2}, Vec3{1, 1, 1}})
    mesh = merged(mesh, translated(make_icosphere(1, 0.1), at));
  return mesh;
}

TEST(SurfaceComponents, CountsBodies) {
  evenmesh::ExecutionContext context(1);
  EXPECT_EQ(surface_components(sampled(make_icosphere(2), 20), context).area.size(), 1u);
  EXPECT_EQ(surface_components(sampled(make_torus(), 30), context).area.size(), 1u);
  EXPECT_EQ(surface_components(sampled(ball_with_small_components(), 60), context).area.size(), 4u);
  EXPECT_EQ(surface_components(sampled_gallery("octic-balls", 60), context).area.size(), 27u);
  EXPECT_EQ(surface_components(sampled_gallery("octic", 80), context).area.size(), 1u);
}

TEST(SurfaceComponents, NumbersPartsByFirstSampleAndAddsUpTheirArea) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(ball_with_small_components(), 60);
  const SurfaceComponents parts = surface_components(samples, context);
  ASSERT_EQ(parts.part.size(), samples.size());
  std::vector<double> area(parts.area.size(), 0);
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_LE(parts.part[i], next);
    if (parts.part[i] == next) ++next;
    area[parts.part[i]] += samples.area[i];
  }
  EXPECT_EQ(next, area.size());
  for (std::size_t p = 0; p < area.size(); ++p) EXPECT_NEAR(parts.area[p], area[p], 1e-9);
}

TEST(DropSmallComponents, RemovesThemAndKeepsTheRestInOrder) {
  evenmesh::ExecutionContext context(1);
  const SampleSet before = sampled(ball_with_small_components(), 60);
  const auto [samples, dropped] = drop_small_components(before, 0.5, context);
  EXPECT_EQ(dropped, 3u);
  EXPECT_LT(samples.size(), before.size());
  expect_well_formed(samples);
  expect_one_sign_grid(samples);
  EXPECT_NEAR(samples.total_area, 4 * 3.14159265, 0.2);
  EXPECT_EQ(samples.source.size(), samples.size());
  EXPECT_EQ(surface_components(samples, context).area.size(), 1u);
  const auto seeds = blue_noise_start(samples, 100, 1);
  auto labels = nearest_labels(samples, seeds);
  const LabelComplex complex = connect_labels(samples, labels, seeds, context);
  EXPECT_EQ(complex.surface_euler, 2);
  EXPECT_TRUE(is_closed_manifold(complex.triangles, complex.labels));
}

TEST(DropSmallComponents, LeavesSurfacesWithoutAnyAlone) {
  evenmesh::ExecutionContext context(1);
  const SampleSet before = sampled(ball_with_small_components(), 60);
  const RemainingSurface rest = drop_small_components(before, 1e-6, context);
  EXPECT_EQ(rest.dropped, 0u);
  expect_same(rest.samples, before);
}

TEST(DropSmallComponents, MayDropEverything) {
  evenmesh::ExecutionContext context(1);
  const auto [samples, dropped] = drop_small_components(sampled(make_icosphere(1), 12), 100, context);
  EXPECT_EQ(dropped, 1u);
  EXPECT_EQ(samples.size(), 0u);
  EXPECT_TRUE(samples.blocks.empty());
  EXPECT_NEAR(samples.total_area, 0, 1e-4);
}

/// Two balls of radius 1 and 0.3 (areas 12.6 and 1.1), with so many times the density on the small one.
SampleSet large_and_small_ball(double density_on_small) {
  evenmesh::ExecutionContext context(1);
  const SampleSet even = sampled(merged(make_icosphere(4), translated(make_icosphere(3, 0.3), {1.6, 0, 0})), 60);
  return weigh_by_density(
             even, [&](const Vec3& p) { return p.x > 1.2 ? density_on_small : 1.0; }, context)
      .samples;
}

TEST(DropSmallComponents, LowDensityMakesNoComponentSmall) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = large_and_small_ball(0.1);
  double weight = 0;
  for (const SampleBlock& block : samples.blocks)
    for (std::uint32_t i = block.begin; i < block.end; ++i)
      if (position(samples, block, i).x > 1.2) weight += samples.weight[i];
  ASSERT_LT(weight, 0.5) << "by its weight the small ball would go";
  EXPECT_EQ(drop_small_components(samples, 0.5, context).dropped, 0u);
  EXPECT_EQ(drop_small_components(samples, 1.5, context).dropped, 1u);
}

TEST(DropSmallComponents, HighDensityMakesASmallComponentWorthIt) {
  evenmesh::ExecutionContext context(1);
  const RemainingSurface rest = drop_small_components(large_and_small_ball(10), 1.5, context);
  EXPECT_EQ(rest.dropped, 0u) << "four cells and more are wanted there";
  EXPECT_EQ(drop_small_components(large_and_small_ball(1), 1.5, context).dropped, 1u);
}

}  // namespace
}  // namespace evenmesh
