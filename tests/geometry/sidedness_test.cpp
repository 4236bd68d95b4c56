#include "geometry/sidedness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "geometry/primitives.h"

namespace evenmesh {
namespace {

/// A strip of n × 2 triangles whose ends are joined, turned over or not.
Mesh strip(std::uint32_t n, bool turned) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double u = 2 * std::numbers::pi * i / n, tilt = turned ? u / 2 : 0;
    for (const double t : {-0.3, 0.3})
      mesh.vertices.push_back(
          {(1 + t * std::cos(tilt)) * std::cos(u), (1 + t * std::cos(tilt)) * std::sin(u), t * std::sin(tilt)});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    std::uint32_t a = 2 * i, b = a + 1, c = 2 * ((i + 1) % n), d = c + 1;
    if (turned && i + 1 == n) std::swap(c, d);
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({b, c, d});
  }
  return mesh;
}

std::size_t one_sided(const Mesh& mesh) {
  return one_sided_triangles(mesh, ExecutionContext::silent());
}

TEST(Sidedness, ClosedMeshesHaveEveryEdgeTwice) {
  Mesh ball = make_icosphere(2);
  EXPECT_TRUE(is_closed(ball));
  std::swap(ball.triangles[3][0], ball.triangles[3][1]);
  EXPECT_TRUE(is_closed(ball)) << "whichever way they face";
  ball.triangles.pop_back();
  EXPECT_FALSE(is_closed(ball));
  EXPECT_FALSE(is_closed(make_grid_plane(3, 2)));
}

TEST(Sidedness, OnlyTurnedStripsHaveOneSide) {
  EXPECT_EQ(one_sided(strip(30, true)), 60u);
  EXPECT_EQ(one_sided(strip(30, false)), 0u);
  EXPECT_EQ(one_sided(make_torus()), 0u);
  EXPECT_EQ(one_sided(make_grid_plane(5, 5)), 0u);
  EXPECT_EQ(one_sided(merged(make_icosphere(2), strip(8, true))), 16u);
}

TEST(Sidedness, TrianglesThatFaceWrongWaysDoNotMatter) {
  for (const bool turned : {false, true}) {
    Mesh mesh = strip(50, turned);
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t][0], mesh.triangles[t][2]);
    EXPECT_EQ(one_sided(mesh), turned ? 100u : 0u);
  }
}

}  // namespace
}  // namespace evenmesh
