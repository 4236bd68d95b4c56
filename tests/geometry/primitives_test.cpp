#include "geometry/primitives.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "evenmesh/error.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

double volume_of(const Mesh& mesh) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    volume += dot(a, cross(b, c)) / 6;
  }
  return volume;
}

/// Every directed edge once, with its opposite: closed, two-manifold along edges, consistently oriented.
bool closed_and_oriented(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : directed)
    if (count != 1 || !directed.contains({edge.second, edge.first})) return false;
  return true;
}

int euler_of(const Mesh& mesh) {  // of a closed mesh without unused vertices
  return static_cast<int>(mesh.vertices.size()) - static_cast<int>(mesh.triangles.size()) / 2;
}

TEST(Primitives, BoxFollowsItsBounds) {
  Box box;
  box.add({-1, 0, 2});
  box.add({0.1, 0.3, 7});
  EXPECT_EQ(make_box_around(box, 3).bounds(), box);
}

TEST(Primitives, AreClosedOrientedAndOfTheRightTopology) {
  const std::pair<Mesh, int> shapes[] = {
      {make_icosphere(0), 2}, {make_icosphere(3, 2.5), 2}, {make_torus(), 0},      {make_torus(1, 0.2, 3, 3), 0},
      {make_box(), 2},        {make_box({1, 2, 3}, 5), 2}, {make_tetrahedron(), 2}};
  for (const auto& [mesh, euler] : shapes) {
    EXPECT_TRUE(closed_and_oriented(mesh));
    EXPECT_EQ(euler_of(mesh), euler);
    EXPECT_GT(volume_of(mesh), 0);
  }
}

TEST(Primitives, HaveTheVolumeOfTheirSolids) {
  EXPECT_NEAR(volume_of(make_icosphere(5, 2)), 4.0 / 3 * std::numbers::pi * 8, 0.05);
  EXPECT_NEAR(volume_of(make_torus(1, 0.35, 200, 100)), 2 * std::numbers::pi * std::numbers::pi * 0.35 * 0.35, 0.01);
  EXPECT_NEAR(volume_of(make_box({1, 2, 3}, 4)), 48, 1e-12);
  EXPECT_NEAR(volume_of(make_tetrahedron(std::sqrt(3.0))), 8.0 / 3, 1e-12);
}

TEST(Primitives, GridPlaneFacesUp) {
  const Mesh mesh = make_grid_plane(3, 2, 0.5);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    EXPECT_NEAR(area_normal(a, b, c).z, 0.25, 1e-15);
  }
}

TEST(Primitives, MergedKeepsBothParts) {
  const Mesh both = merged(make_box(), translated(make_box(), {5, 0, 0}));
  EXPECT_TRUE(closed_and_oriented(both));
  EXPECT_EQ(euler_of(both), 4);
  EXPECT_NEAR(both.bounds().hi.x, 6, 1e-15);
}

TEST(Primitives, RefuseNonsense) {
  EXPECT_THROW(make_icosphere(-1), InvalidInput);
  EXPECT_THROW(make_icosphere(2, 0), InvalidInput);
  EXPECT_THROW(make_torus(1, 0.3, 2, 5), InvalidInput);
  EXPECT_THROW(make_box({1, 0, 1}), InvalidInput);
  EXPECT_THROW(make_grid_plane(0, 1), InvalidInput);
}

}  // namespace
}  // namespace evenmesh
