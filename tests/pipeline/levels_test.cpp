/// Seeds by way of coarser meshes.

#include "pipeline/pipeline_testing.h"

namespace evenmesh {
namespace {

struct Case {
  const char *name, *shape;
  std::size_t vertices;
  double q_avg, irregular;  ///< at least, at most
  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
};

class Levels : public testing::TestWithParam<Case> {};

TEST_P(Levels, LeaveFewIrregularVertices) {
  const Case c = GetParam();
  const MeshResult result = meshed(gallery_shape(c.shape), {.vertices = c.vertices});
  expect_good_mesh(result);
  expect_count(result, c.vertices);
  EXPECT_GT(result.report.quality.q_avg, c.q_avg);
  EXPECT_LT(result.report.quality.irregular_ratio, c.irregular);
  EXPECT_LT(result.report.quality.edge_length_cv, 0.12);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Levels,
                         testing::Values(Case{"one_level", "torus", 13'000, 0.98, 0.02},
                                         Case{"with_sharp_edges", "cube", 13'000, 0.97, 0.025},
                                         Case{"of_high_genus", "octic-balls", 16'000, 0.97, 0.035},
                                         Case{"two_levels", "sphere", 50'000, 0.985, 0.005}),
                         [](const auto& of) { return of.param.name; });

TEST(Levels, GradedMeshesHaveThem) {
  const MeshOptions options{.vertices = 13'000, .density = density_from_expression("1 + 2 exp(-4 (x - 1)^2)")};
  const MeshResult result = meshed(gallery_shape("sphere"), options);
  expect_good_mesh(result);
  EXPECT_GT(result.report.quality.q_avg, 0.97);
  EXPECT_LT(result.report.quality.irregular_ratio, 0.02);
}

TEST(Levels, ThreadsDoNotMatter) {
  const MeshOptions options{.vertices = 13'000};
  const Shape shape = gallery_shape("tangle");
  const MeshResult one = meshed(shape, options, 1), many = meshed(shape, options, 7);
  EXPECT_EQ(one.mesh.vertices, many.mesh.vertices);
  EXPECT_EQ(one.mesh.triangles, many.mesh.triangles);
}

/// A coarse grid would lose much of it.
TEST(Levels, AreNotNeeded) {
  const MeshResult result = meshed(gallery_shape("menger-2"), {.vertices = 14'000});
  expect_good_mesh(result);
  EXPECT_EQ(result.report.quality.euler, -160);
}

TEST(Levels, EvennessIsADial) {
  const Shape shape = gallery_shape("heart");
  const MeshQuality shapes = meshed(shape, {.vertices = 3'000, .evenness = 0}).report.quality;
  const MeshQuality sizes = meshed(shape, {.vertices = 3'000, .evenness = 1}).report.quality;
  EXPECT_GT(shapes.q_avg, sizes.q_avg);
  EXPECT_GT(shapes.edge_length_cv, sizes.edge_length_cv);
}

}  // namespace
}  // namespace evenmesh
