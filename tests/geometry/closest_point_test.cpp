#include "geometry/closest_point.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "evenmesh/error.h"
#include "geometry/primitives.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

ClosestPoint by_trying_all(const Mesh& mesh, const Vec3& p) {
  ClosestPoint best;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    const Vec3 point = closest_point_on_triangle(p, a, b, c);
    const double squared = squared_norm(point - p);
    if (squared < best.squared_distance) best = {point, static_cast<std::uint32_t>(t), squared};
  }
  return best;
}

Vec3 random_point(Random& random, double size) {
  const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
  return size * Vec3{x, y, z};
}

void expect_same_as_trying_all(const Mesh& mesh, const Vec3& around, double size) {
  const SurfaceQuery query(mesh);
  Random random(7);
  for (int n = 0; n < 200; ++n) {
    // Every third query is a vertex: there several triangles are at the same distance.
    const Vec3 p =
        n % 3 == 0 ? mesh.vertices[random.below(mesh.vertices.size())] : around + random_point(random, n % 3 * size);
    const ClosestPoint expected = by_trying_all(mesh, p), found = query.closest(p);
    EXPECT_EQ(found.squared_distance, expected.squared_distance);
    EXPECT_EQ(found.triangle, expected.triangle);
    EXPECT_EQ(found.point, expected.point);
  }
}

TEST(ClosestPoint, AgreesWithTryingAllTriangles) {
  expect_same_as_trying_all(make_icosphere(3), {}, 1.0);
  expect_same_as_trying_all(make_torus(), {}, 0.5);
  expect_same_as_trying_all(make_box(), {}, 20.0);
}

TEST(ClosestPoint, IsExactFarFromTheOriginAndForFarPoints) {
  const Vec3 away{1e6, -2e6, 3e5};
  expect_same_as_trying_all(translated(make_icosphere(3), away), away, 1.0);
  expect_same_as_trying_all(make_icosphere(2, 1e-3), {}, 1e3);
  expect_same_as_trying_all(make_icosphere(2, 1e-50), {}, 1e-50);
  expect_same_as_trying_all(make_icosphere(2, 1e50), {}, 1e50);
}

TEST(ClosestPoint, AgreesOnASoupWithDegenerateTriangles) {
  Random random(11);
  Mesh mesh;
  for (std::uint32_t t = 0; t < 300; ++t) {
    const Vec3 center = random_point(random, 1);
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(center + random_point(random, 0.2));
    if (t % 5 == 0) mesh.vertices.back() = mesh.vertices[mesh.vertices.size() - 2];
    if (t % 7 == 0) mesh.vertices.back() = 0.5 * (mesh.vertices[3 * t] + mesh.vertices[3 * t + 1]);
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  expect_same_as_trying_all(mesh, {}, 0.7);
}

TEST(ClosestPoint, StopsAtTheLimit) {
  const SurfaceQuery query(make_box());
  EXPECT_FALSE(query.closest({3, 0, 0}, 1.9).found());
  EXPECT_TRUE(query.closest({3, 0, 0}, 2.0).found());
  EXPECT_EQ(query.closest({3, 0, 0}, 2.1).point, (Vec3{1, 0, 0}));
  EXPECT_EQ(query.closest({1, 0.25, 0.5}, 0).squared_distance, 0);
  EXPECT_FALSE(query.closest({std::nan(""), 0, 0}).found());
}

TEST(ClosestPoint, NeedsATriangle) {
  EXPECT_THROW(SurfaceQuery(Mesh{}), InvalidInput);
}

TEST(Triangle, ClosestPointIsNearerThanAnySample) {
  Random random(13);
  for (int n = 0; n < 200; ++n) {
    const Vec3 a = random_point(random, 1), b = random_point(random, 1), c = random_point(random, n % 4 ? 1 : 1e-9);
    const Vec3 p = random_point(random, 2), q = closest_point_on_triangle(p, a, b, c);
    for (int i = 0; i <= 12; ++i)
      for (int j = 0; i + j <= 12; ++j) {
        const Vec3 s = (i / 12.0) * a + (j / 12.0) * b + ((12 - i - j) / 12.0) * c;
        EXPECT_LE(norm(p - q), norm(p - s) + 1e-12);
      }
  }
}

}  // namespace
}  // namespace evenmesh
