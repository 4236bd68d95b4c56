#include "geometry/point_hash.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.h"

namespace evenmesh {
namespace {

Vec3 random_point(Random& random) {
  return {4 * random.uniform() - 2, 4 * random.uniform() - 2, 4 * random.uniform() - 2};
}

std::vector<Vec3> random_points(std::size_t count) {
  Random random(11);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(random_point(random));
  return points;
}

std::vector<std::uint32_t> near_by_hand(const std::vector<Vec3>& points, const Vec3& p, double reach) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (squared_norm(points[i] - p) <= reach * reach) found.push_back(i);
  return found;
}

std::vector<std::uint32_t> visited(const PointHash& hash, const Vec3& p, double reach) {
  std::vector<std::uint32_t> found;
  EXPECT_FALSE(hash.near(p, reach, [&](std::uint32_t i) { found.push_back(i); }));
  return found;
}

TEST(PointHash, FindsWhatTryingAllPointsFinds) {
  Random random(5);
  const std::vector<Vec3> points = random_points(2000);
  for (const double side : {0.003, 0.1, 1.0, 10.0}) {
    const PointHash hash(points, side, {-0.3, 0.1, 5});
    for (const double reach : {0.0, 0.05, 0.4, 3.0})
      for (int round = 0; round < 20; ++round) {
        const Vec3 p = round % 2 == 0 ? points[random.below(points.size())] : random_point(random);
        std::vector<std::uint32_t> found = visited(hash, p, reach);
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, near_by_hand(points, p, reach)) << side << " " << reach;
      }
  }
}

TEST(PointHash, VisitsInTheSameOrderHoweverItWasFilled) {
  const std::vector<Vec3> points = random_points(500);
  const PointHash at_once(points, 0.5);
  PointHash grown(0.5);
  for (const Vec3& p : points) grown.add(p);
  for (const Vec3& p : points) EXPECT_EQ(visited(at_once, p, 0.5), visited(grown, p, 0.5));
}

TEST(PointHash, CellsByZThenYThenXAndPointsAsAdded) {
  PointHash hash(1);
  for (const Vec3& p : {Vec3{0.5, 0.5, 1.5}, Vec3{1.5, 0.5, 0.5}, Vec3{0.5, 1.5, 0.5}, Vec3{0.5, 0.5, 0.5},
                        Vec3{0.4, 0.4, 0.4}, Vec3{-0.5, 0.5, 0.5}})
    hash.add(p);
  EXPECT_EQ(visited(hash, {0.5, 0.5, 0.5}, 1.5), (std::vector<std::uint32_t>{5, 3, 4, 1, 2, 0}));
}

TEST(PointHash, StopsWhereItIsTold) {
  const std::vector<Vec3> points(10, Vec3{1, 1, 1});
  const PointHash hash(points, 1);
  int asked = 0;
  EXPECT_TRUE(hash.near({1, 1, 1}, 0.5, [&](std::uint32_t i) { return ++asked, i == 3; }));
  EXPECT_EQ(asked, 4);
  EXPECT_FALSE(hash.near({1, 1, 1}, 0.5, [](std::uint32_t) { return false; }));
}

TEST(PointHash, EmptyFindsNothing) {
  EXPECT_TRUE(visited(PointHash(1), {0, 0, 0}, 1e9).empty());
}

TEST(PointHash, FarOutliersAndWideReachesCostNothing) {
  std::vector<Vec3> points = random_points(100);
  points.push_back({1e12, -1e12, 1e12});
  points.push_back({-1e300, 0, 0});
  const PointHash hash(points, 1e-3);
  EXPECT_EQ(visited(hash, {0, 0, 0}, 100).size(), 100u);
  EXPECT_EQ(visited(hash, {1e12, -1e12, 1e12}, 1), std::vector<std::uint32_t>{100});
}

}  // namespace
}  // namespace evenmesh
