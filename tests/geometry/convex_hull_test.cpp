#include "geometry/convex_hull.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "core/random.h"
#include "geometry/primitives.h"

namespace evenmesh {
namespace {

double volume(const Mesh& mesh) {
  double six = 0;
  for (const Triangle& t : mesh.triangles)
    six += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]]));
  return six / 6;
}

/// Closed, a ball, facing outward, no point outside of any face.
void expect_hull_of(const std::vector<Vec3>& points) {
  const Mesh hull = convex_hull(points);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  std::map<std::uint32_t, int> corners;
  for (const Triangle& t : hull.triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      ++corners[t[c]];
      EXPECT_EQ(++edges[std::pair(t[c], t[(c + 1) % 3])], 1);
    }
  for (const auto& [edge, count] : edges) EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  EXPECT_EQ(corners.size() + hull.triangles.size(), edges.size() / 2 + 2) << "Euler number";
  std::size_t outside = 0, flat = 0;
  for (const Triangle& t : hull.triangles) {
    flat += collinear(points[t[0]], points[t[1]], points[t[2]]);
    for (const Vec3& p : points) outside += orient3d(points[t[0]], points[t[1]], points[t[2]], p) > 0;
  }
  EXPECT_EQ(outside, 0u);
  EXPECT_EQ(flat, 0u);
  EXPECT_GT(volume(hull), 0);
}

TEST(ConvexHull, OfRandomPoints) {
  Random random(7);
  for (const std::size_t count : {4u, 5u, 12u, 100u, 800u}) {
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back({random.uniform(), random.uniform(), random.uniform()});
    expect_hull_of(points);
    for (Vec3& p : points) p = normalized(p - Vec3{0.5, 0.5, 0.5});
    expect_hull_of(points);
  }
}

TEST(ConvexHull, OfPointsThatShareFaces) {
  std::vector<Vec3> lattice;
  for (int i = 0; i < 6 * 6 * 6; ++i) lattice.push_back({double(i % 6), double(i / 6 % 6), double(i / 36)});
  expect_hull_of(lattice);
  EXPECT_DOUBLE_EQ(volume(convex_hull(lattice)), 125);
  // In a plane across the axes nothing is coplanar but by its exact coordinates.
  for (Vec3& p : lattice) p = {0.1 * p.x + 0.7 * p.y, 0.3 * p.x - 0.2 * p.y + 0.9 * p.z, 1.1 * p.x + 0.1 * p.z};
  expect_hull_of(lattice);
  Mesh twice = merged(make_torus(), make_torus());
  expect_hull_of(twice.vertices);
}

TEST(ConvexHull, FlatPointsHaveNone) {
  EXPECT_TRUE(convex_hull(std::span<const Vec3>{}).triangles.empty());
  const std::vector<Vec3> line{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {0, 0, 0}};
  EXPECT_TRUE(convex_hull(line).triangles.empty());
  EXPECT_TRUE(convex_hull(make_grid_plane(4, 4).vertices).triangles.empty());
}

TEST(ConvexHull, InThePlane) {
  std::vector<Point2> grid;
  for (int i = 0; i < 25; ++i) grid.push_back({double(i % 5), double(i / 5)});
  const std::vector<Point2> corners = convex_hull(grid);
  ASSERT_EQ(corners.size(), 4u) << "no points on straight edges";
  double twice = 0;
  for (std::size_t i = 0; i < 4; ++i)
    twice += corners[i].x * corners[(i + 1) % 4].y - corners[i].y * corners[(i + 1) % 4].x;
  EXPECT_EQ(twice, 32);
  EXPECT_LT(convex_hull(std::vector<Point2>{{0, 0}, {1, 1}, {2, 2}, {1, 1}}).size(), 3u);
  EXPECT_TRUE(convex_hull(std::vector<Point2>{}).empty());
}

}  // namespace
}  // namespace evenmesh
