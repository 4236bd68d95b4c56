#include "grid/surface_components.h"

#include "connect/connect_testing.h"

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

TEST(DropDust, RemovesSpecksAndKeepsTheRestInOrder) {
  evenmesh::ExecutionContext context(1);
  SampleSet samples = sampled(ball_with_small_components(), 60);
  const std::size_t before = samples.size();
  EXPECT_EQ(drop_small_components(samples, 0.5, context), 3u);
  EXPECT_LT(samples.size(), before);
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

TEST(DropDust, LeavesSurfacesWithoutSpecksAlone) {
  evenmesh::ExecutionContext context(1);
  SampleSet samples = sampled(ball_with_small_components(), 60);
  const SampleSet before = samples;
  EXPECT_EQ(drop_small_components(samples, 1e-6, context), 0u);
  expect_same(samples, before);
}

TEST(DropDust, MayDropEverything) {
  evenmesh::ExecutionContext context(1);
  SampleSet samples = sampled(make_icosphere(1), 12);
  EXPECT_EQ(drop_small_components(samples, 100, context), 1u);
  EXPECT_EQ(samples.size(), 0u);
  EXPECT_TRUE(samples.blocks.empty());
  EXPECT_NEAR(samples.total_area, 0, 1e-4);
}

}  // namespace
}  // namespace evenmesh
