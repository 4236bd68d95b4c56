#include "geometry/quadric.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "geometry/plane_fit.h"

namespace evenmesh {
namespace {

Vec3 random_point(Random& random) {
  return {random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
}

void expect_near(const Vec3& a, const Vec3& b, double error) {
  EXPECT_LT(norm(a - b), error) << a.x << " " << a.y << " " << a.z << ", not " << b.x << " " << b.y << " " << b.z;
}

TEST(Quadric, ThreePlanesMeetInAPoint) {
  Random random(2);
  for (int round = 0; round < 50; ++round) {
    const Vec3 corner = random_point(random);
    Quadric planes;
    for (int i = 0; i < 6; ++i) {
      const Vec3 n = normalized(random_point(random)), aside = cross(n, random_point(random));
      planes.add_plane(corner + aside, n, 1 + random.uniform());
    }
    EXPECT_EQ(planes.rank(), 3);
    expect_near(planes.minimum(), corner, 1e-10);
    expect_near(planes.minimum(3, 3), corner, 1e-10);
  }
}

TEST(Quadric, PlanesOfACreaseMeetAtThePointOfItThatIsNearestToTheirMean) {
  Quadric planes;
  for (const double y : {1.0, 2.0, 3.0}) {
    planes.add_plane({-1, y, 0}, {0, 0, 1});
    planes.add_plane({0, y, -1}, {1, 0, 0});
  }
  EXPECT_EQ(planes.rank(), 2);
  expect_near(planes.minimum(2, 2), {0, 2, 0}, 1e-12);
  expect_near(planes.minimum(2, 3), {0, 2, 0}, 1e-12);
}

TEST(Quadric, DirectionsThatHardlyDifferCountOnlyWhereTheyAreWanted) {
  Quadric planes;  // two planes that lean by five degrees
  const double s = std::sin(0.0436), c = std::cos(0.0436);
  planes.add_plane({2, 0, -2 * s / c}, {s, 0, c});
  planes.add_plane({2, 0, 2 * s / c}, {-s, 0, c});
  EXPECT_EQ(planes.rank(), 1);
  expect_near(planes.minimum(1, 3), {2, 0, 0}, 1e-9);
  expect_near(planes.minimum(2, 3), {0, 0, 0}, 1e-9);
}

TEST(Quadric, APointMakesTheMinimumUnique) {
  Quadric plane;
  plane.add_plane({0, 0, 1}, {0, 0, 1}, 2);
  plane.add_point({5, 6, 7}, 1);
  expect_near(plane.minimum(), {5, 6, 3}, 1e-12);  // (2 · 1 + 1 · 7) / 3
  EXPECT_EQ(plane.weight(), 2);
  EXPECT_EQ(plane.mean(), (Vec3{0, 0, 1}));
}

TEST(Quadric, SumsAreOfAllPlanes) {
  Random random(9);
  Quadric all, half[2];
  for (int i = 0; i < 20; ++i) {
    const Vec3 p = random_point(random), n = normalized(random_point(random));
    all.add_plane(p, n);
    half[i % 2].add_plane(p, n);
  }
  half[0].add(half[1]);
  EXPECT_EQ(half[0].weight(), all.weight());
  expect_near(half[0].mean(), all.mean(), 1e-14);
  expect_near(half[0].minimum(), all.minimum(), 1e-12);
}

TEST(PlaneFit, FindsThePlaneOfItsPoints) {
  Random random(4);
  for (int round = 0; round < 50; ++round) {
    const Vec3 n = normalized(random_point(random)), u = normalized(cross(n, random_point(random))), v = cross(n, u);
    PlaneFit fit;
    const Vec3 center = random_point(random);
    for (int i = 0; i < 30; ++i)
      fit.add(center + (random.uniform() - 0.5) * u + 2 * (random.uniform() - 0.5) * v, 0.1 + random.uniform());
    const PlaneFit::Plane plane = fit.plane();
    EXPECT_EQ(fit.count(), 30u);
    EXPECT_NEAR(std::abs(dot(plane.normal, n)), 1, 1e-10);
    EXPECT_NEAR(plane.variance[0], 0, 1e-14);
    EXPECT_GT(plane.variance[1], 0.02);
    EXPECT_GT(plane.variance[2], plane.variance[1]);
  }
}

TEST(PlaneFit, PointsOnALineSpreadOneWay) {
  PlaneFit fit;
  for (int i = 0; i < 5; ++i) fit.add({1, 2.0 * i, 3});
  EXPECT_NEAR(fit.plane().variance[1], 0, 1e-12);
  EXPECT_NEAR(fit.plane().variance[2], 8, 1e-12);  // of 0, 2, 4, 6, 8
}

}  // namespace
}  // namespace evenmesh
