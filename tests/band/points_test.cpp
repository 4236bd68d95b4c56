/// Spacing and outliers of point clouds whose density is known.

#include "evenmesh/points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "geometry/point_tree.h"

namespace evenmesh {
namespace {

/// Hexagonal pattern in a tilted plane.
PointCloud plane(std::size_t side, double spacing, const Vec3& origin = {}) {
  const Vec3 u{0.6, 0.8, 0}, v{0, 0, 1};
  PointCloud cloud;
  for (std::size_t i = 0; i < side; ++i) {
    for (std::size_t j = 0; j < side; ++j) {
      const double a = static_cast<double>(i) + 0.5 * static_cast<double>(j % 2);
      const double b = 0.5 * std::numbers::sqrt3 * static_cast<double>(j);
      cloud.points.push_back(origin + spacing * (a * u + b * v));
    }
  }
  return cloud;
}

PointCloud ball(std::size_t count, std::uint64_t seed = 1) {
  Random random(seed);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = normalized({random.gaussian(), random.gaussian(), random.gaussian()});
    cloud.points.push_back(p);
    cloud.normals.push_back(p);
  }
  return cloud;
}

TEST(PointSpacing, OfARegularPlaneIsItsSpacing) {
  for (const double spacing : {1.0, 0.003, 1e-160, 1e150}) {
    EXPECT_NEAR(point_spacing(plane(60, spacing)) / spacing, 1, 1e-9) << spacing;
  }
  EXPECT_NEAR(point_spacing(plane(60, 0.01, {1000, -2000, 500})), 0.01, 1e-8);
}

TEST(PointSpacing, OfARandomSphereFollowsItsDensity) {
  for (const std::size_t count : {2'000u, 200'000u}) {
    const double density = static_cast<double>(count) / (4 * std::numbers::pi);
    const double wanted = std::sqrt(6 / (std::numbers::pi * density));
    EXPECT_NEAR(point_spacing(ball(count)), wanted, 0.05 * wanted) << count;
  }
}

TEST(PointSpacing, CountsRepeatedPointsOnce) {
  PointCloud cloud = plane(40, 1);
  const std::vector<Vec3> once = cloud.points;
  for (int i = 0; i < 7; ++i) cloud.points.insert(cloud.points.end(), once.begin(), once.end());
  EXPECT_NEAR(point_spacing(cloud), 1, 1e-9);
  EXPECT_EQ(point_spacing({std::vector<Vec3>(100'000, Vec3{1, 2, 3}), {}}), 0);
}

TEST(PointSpacing, OfFewPointsIsTheDistanceToTheFarthest) {
  EXPECT_EQ(point_spacing({}), 0);
  EXPECT_EQ(point_spacing({{{1, 2, 3}}, {}}), 0);
  EXPECT_EQ(point_spacing({{{0, 0, 0}, {0, 3, 4}}, {}}), 5);
  EXPECT_THROW(point_spacing({{{0, 0, 0}, {0, std::nan(""), 4}}, {}}), InvalidInput);
}

TEST(PointSpacing, AFarPointDoesNoHarm) {
  PointCloud cloud = plane(200, 1);
  cloud.points.push_back({1e12, -1e12, 1e12});
  EXPECT_NEAR(point_spacing(cloud), 1, 1e-3);  // the plane's coordinates are still exact to 1e-4 in double
}

TEST(PointSpacing, IsTheSameForAnyThreads) {
  const PointCloud cloud = ball(150'000);
  evenmesh::ExecutionContext one(1), two(2);
  EXPECT_EQ(point_spacing(cloud, one), point_spacing(cloud, two));
}

TEST(PointTree, FindsTheNearestOfAll) {
  PointCloud cloud = ball(700);
  for (int i = 0; i < 100; ++i) cloud.points.push_back({0.01 * i, 0.5, 0.5});  // and points of a line
  const PointTree tree(cloud.points, ExecutionContext::silent());
  ASSERT_EQ(tree.size(), cloud.points.size());
  Random random(2);
  for (int n = 0; n < 300; ++n) {
    const Vec3 p = n % 2 == 0 ? tree.point(random.below(tree.size()))
                              : Vec3{3 * random.uniform() - 1.5, random.uniform(), random.uniform()};
    std::vector<double> all, found(1 + random.below(20));
    for (const Vec3& q : cloud.points)
      if (q != p) all.push_back(norm(q - p));
    std::sort(all.begin(), all.end());
    tree.nearest(p, found);
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], all[i], 1e-12);
  }
}

TEST(Outliers, PlantedOnesGoAndTheRestStaysInOrder) {
  const PointCloud clean = ball(20'000);
  PointCloud cloud = clean;
  Random random(3);
  for (std::size_t i = 0; i < 40; ++i) {
    const Vec3 p = (1.3 + random.uniform()) * ball(1, 100 + i).points[0];
    const auto at = static_cast<std::ptrdiff_t>(random.below(cloud.points.size()));
    cloud.points.insert(cloud.points.begin() + at, p);
    cloud.normals.insert(cloud.normals.begin() + at, p);
  }
  const PointCloud kept = remove_outliers(cloud);
  EXPECT_EQ(kept.points, clean.points);
  EXPECT_EQ(kept.normals, clean.normals);
}

TEST(Outliers, AnEvenCloudHasNone) {
  PointCloud cloud = ball(5'000);
  cloud.normals.clear();
  EXPECT_GE(remove_outliers(cloud, {.deviations = 6}).points.size(), 4'999u);
  // On a line that closes, all points have the same distances up to rounding.
  PointCloud ring;
  for (int i = 0; i < 360; ++i)
    ring.points.push_back({std::cos(i * std::numbers::pi / 180), std::sin(i * std::numbers::pi / 180), 0});
  EXPECT_EQ(remove_outliers(ring, {.neighbours = 2, .deviations = 0}).points.size(), 360u);
  EXPECT_EQ(remove_outliers({{{1, 1, 1}}, {}}).points.size(), 1u);
  EXPECT_TRUE(remove_outliers({}).points.empty());
}

TEST(Outliers, AreTheSameForAnyThreads) {
  const PointCloud cloud = ball(30'000);
  evenmesh::ExecutionContext one(1), two(2);
  EXPECT_EQ(remove_outliers(cloud, {.deviations = 1}, one).points,
            remove_outliers(cloud, {.deviations = 1}, two).points);
}

TEST(Outliers, OptionsOutOfRangeAreRefused) {
  const PointCloud cloud = ball(10);
  EXPECT_THROW(remove_outliers(cloud, {.neighbours = 0}), InvalidInput);
  EXPECT_THROW(remove_outliers(cloud, {.neighbours = 65}), InvalidInput);
  EXPECT_THROW(remove_outliers(cloud, {.deviations = -1}), InvalidInput);
  EXPECT_THROW(remove_outliers(cloud, {.deviations = std::nan("")}), InvalidInput);
  EXPECT_THROW(remove_outliers({cloud.points, {{0, 0, 1}}}), InvalidInput);
  evenmesh::ExecutionContext context;
  context.cancel();
  EXPECT_THROW(remove_outliers(cloud, {}, context), Cancelled);
}

}  // namespace
}  // namespace evenmesh
