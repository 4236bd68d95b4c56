#include <gtest/gtest.h>

#include "evenmesh/measure.h"
#include "geometry/primitives.h"

namespace evenmesh {
namespace {

const CompareOptions few{.samples = 20'000};

TEST(Distance, BetweenConcentricSpheresIsTheDifferenceOfTheirRadii) {
  const MeshDistance d = compare_meshes(make_icosphere(5), make_icosphere(5, 1.1), few);
  EXPECT_NEAR(d.a_to_b_max, 0.1, 2e-3);
  EXPECT_NEAR(d.b_to_a_max, 0.1, 2e-3);
  EXPECT_NEAR(d.a_to_b_rms, 0.1, 2e-3);
  EXPECT_NEAR(d.b_to_a_mean, 0.1, 2e-3);
  EXPECT_LT(d.normal_deviation_avg, 3);
  EXPECT_NEAR(d.reference_diagonal, 2.2 * std::sqrt(3.0), 0.02);
  EXPECT_EQ(d.hausdorff(), std::max(d.a_to_b_max, d.b_to_a_max));
}

TEST(Distance, ToItselfIsNone) {
  const MeshDistance d = compare_meshes(make_torus(), make_torus(), few);
  EXPECT_NEAR(d.hausdorff(), 0, 1e-12);
  EXPECT_NEAR(d.normal_deviation_avg, 0, 1e-6);
}

TEST(Distance, IsOneSided) {
  const Mesh a = make_icosphere(3), both = merged(a, translated(a, {5, 0, 0}));
  const MeshDistance d = compare_meshes(a, both, few);
  EXPECT_NEAR(d.a_to_b_max, 0, 1e-12);
  EXPECT_NEAR(d.b_to_a_max, 5, 1e-2);
  EXPECT_NEAR(compare_meshes(both, a, few).a_to_b_rms, d.b_to_a_rms, 1e-9);
}

TEST(Distance, OfAShiftedPlaneIsTheShift) {
  const MeshDistance d = compare_meshes(make_grid_plane(5, 5), translated(make_grid_plane(5, 5), {0, 0, 0.25}), few);
  EXPECT_NEAR(d.a_to_b_max, 0.25, 1e-12);
  EXPECT_NEAR(d.a_to_b_mean, 0.25, 1e-12);
  EXPECT_NEAR(d.b_to_a_rms, 0.25, 1e-12);
}

TEST(Distance, OppositeOrientationTurnsTheNormals) {
  Mesh flipped = make_icosphere(2);
  for (Triangle& t : flipped.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(compare_meshes(make_icosphere(2), flipped, few).normal_deviation_avg, 180, 1);
}

TEST(Distance, IgnoresUnusedVerticesAndDegenerateTriangles) {
  Mesh mesh = make_icosphere(2);
  mesh.vertices.push_back({100, 0, 0});
  mesh.triangles.push_back({0, 0, 0});
  EXPECT_NEAR(compare_meshes(mesh, make_icosphere(2), few).hausdorff(), 0, 1e-12);
}

TEST(Distance, IsTheSameForAnyNumberOfThreads) {
  const Mesh a = make_icosphere(3), b = make_box({0.9, 0.8, 0.7}, 3);
  evenmesh::ExecutionContext one(1), three(3);
  const MeshDistance x = compare_meshes(a, b, few, one), y = compare_meshes(a, b, few, three);
  EXPECT_EQ(x.a_to_b_rms, y.a_to_b_rms);
  EXPECT_EQ(x.b_to_a_mean, y.b_to_a_mean);
  EXPECT_EQ(x.normal_deviation_avg, y.normal_deviation_avg);
  EXPECT_EQ(x.hausdorff(), y.hausdorff());
}

TEST(Distance, RefusesNonsense) {
  EXPECT_THROW(compare_meshes(Mesh{}, make_box()), InvalidInput);
  EXPECT_THROW(compare_meshes(make_box(), make_box(), {.samples = 0}), InvalidInput);
}

}  // namespace
}  // namespace evenmesh
