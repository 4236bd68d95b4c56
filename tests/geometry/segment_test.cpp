#include "geometry/segment.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace evenmesh {
namespace {

Vec3 random_point(Random& random) {
  return {random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
}

TEST(Segment, NothingOnItIsNearer) {
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    const Vec3 p = random_point(random), a = random_point(random), b = random_point(random);
    const SegmentPoint found = closest_point_on_segment(p, a, b);
    EXPECT_NEAR(norm(found.point - (a + found.share * (b - a))), 0, 1e-15);
    EXPECT_NEAR(squared_norm(p - found.point), found.squared_distance, 1e-15);
    for (int i = 0; i <= 50; ++i) EXPECT_LE(found.squared_distance, squared_norm(a + (i / 50.0) * (b - a) - p) + 1e-15);
  }
}

TEST(Segment, EndsAreTheNearestBeyondThem) {
  const Vec3 a{1, 0, 0}, b{3, 0, 0};
  EXPECT_EQ(closest_point_on_segment({0, 1, 0}, a, b).point, a);
  EXPECT_EQ(closest_point_on_segment({0, 1, 0}, a, b).share, 0);
  EXPECT_EQ(closest_point_on_segment({5, 0, 0}, a, b).point, b);
  EXPECT_EQ(closest_point_on_segment({5, 0, 0}, a, b).squared_distance, 4);
  EXPECT_EQ(closest_point_on_segment({1.5, 2, 0}, a, b).share, 0.25);
}

TEST(Segment, MayHaveNoLength) {
  const SegmentPoint found = closest_point_on_segment({0, 3, 4}, {0, 0, 0}, {0, 0, 0});
  EXPECT_EQ(found.point, (Vec3{0, 0, 0}));
  EXPECT_EQ(found.squared_distance, 25);
}

}  // namespace
}  // namespace evenmesh
