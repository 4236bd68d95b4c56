#include "geometry/predicates.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.h"

namespace evenmesh {
namespace {

using Wide = __int128;
using IntPoint = std::array<std::int64_t, 3>;

int sign_of(Wide x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}
Vec3 to_vec(const IntPoint& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/// For coordinates below 2^38: nothing exceeds 127 bits.
int orient3d_reference(const IntPoint& a, const IntPoint& b, const IntPoint& c, const IntPoint& d) {
  const auto diff = [&](const IntPoint& p, int k) { return static_cast<Wide>(p[k] - a[k]); };
  Wide sum = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    sum += diff(d, k) * (diff(b, i) * diff(c, j) - diff(b, j) * diff(c, i));
  }
  return sign_of(sum);
}

std::int64_t random_integer(Random& random, std::int64_t limit) {
  return static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(2 * limit + 1))) - limit;
}

TEST(Predicates, HaveTheDocumentedSigns) {
  EXPECT_EQ(orient2d({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orient2d({0, 0}, {0, 1}, {1, 0}), -1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}), -1);
  EXPECT_TRUE(collinear({0, 0, 0}, {1, 2, 3}, {-2, -4, -6}));
  EXPECT_TRUE(collinear({1, 2, 3}, {1, 2, 3}, {7, 8, 9}));
  EXPECT_FALSE(collinear({0, 0, 0}, {1, 2, 3}, {2, 4, std::nextafter(6, 7)}));
}

TEST(Predicates, DropAxisKeepsTheSignOfTheNormal) {
  Random random(3);
  for (int n = 0; n < 100; ++n) {
    Vec3 p[3];
    for (Vec3& q : p) q = {random.uniform(), random.uniform(), random.uniform()};
    const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(orient2d(drop_axis(p[0], axis), drop_axis(p[1], axis), drop_axis(p[2], axis)),
                normal[axis] > 0 ? 1 : -1);
  }
}

TEST(Predicates, Orient3dAgreesWithIntegersNearCoplanarity) {
  Random random(1);
  for (int n = 0; n < 20000; ++n) {
    const std::int64_t limit = n % 2 ? 3 : (std::int64_t{1} << 36) - 5;
    IntPoint p[4];
    for (IntPoint& q : p)
      for (auto& x : q) x = random_integer(random, limit);
    if (n % 4 == 0) {  // nearly (or exactly) in the plane of the others: the middle of an edge plus a little
      for (int k = 0; k < 3; ++k) p[3][k] = (p[0][k] + p[1][k]) / 2 + random_integer(random, 1);
    }
    EXPECT_EQ(orient3d(to_vec(p[0]), to_vec(p[1]), to_vec(p[2]), to_vec(p[3])),
              orient3d_reference(p[0], p[1], p[2], p[3]));
  }
}

/// Points with x + y + z = 0 of so different sizes that their differences are no doubles; d off that plane by -1, 0, 1.
TEST(Predicates, Orient3dIsExactWhereDifferencesRound) {
  Random random(2);
  for (int n = 0; n < 20000; ++n) {
    const auto point_in_plane = [&](std::int64_t sum) {
      const bool large = random.below(2) == 0 && sum == 0;
      const std::int64_t scale = large ? 1024 : 1, limit = large ? std::int64_t{1} << 50 : std::int64_t{1} << 40;
      const std::int64_t x = scale * random_integer(random, limit), y = scale * random_integer(random, limit);
      return IntPoint{x, y, sum - x - y};
    };
    const IntPoint a = point_in_plane(0), b = point_in_plane(0), c = point_in_plane(0);
    const std::int64_t off = random_integer(random, 1);
    const IntPoint d = point_in_plane(off);
    // The normal of the plane is ± (1, 1, 1): its sign is that of its z component.
    const Wide area = static_cast<Wide>(b[0] - a[0]) * (c[1] - a[1]) - static_cast<Wide>(b[1] - a[1]) * (c[0] - a[0]);
    EXPECT_EQ(orient3d(to_vec(a), to_vec(b), to_vec(c), to_vec(d)), sign_of(area) * sign_of(off));
  }
}

/// Shewchuk's example: a tiny grid of points around a line, where plain evaluation gives stripes.
TEST(Predicates, Orient2dIsExactAroundALine) {
  const std::int64_t unit = std::int64_t{1} << 53;
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j) {
      const Point2 p{0.5 + i * 0x1p-53, 0.5 + j * 0x1p-53};
      const auto px = static_cast<std::int64_t>(p.x * 0x1p53), py = static_cast<std::int64_t>(p.y * 0x1p53);
      const Wide reference =
          static_cast<Wide>(12 * unit - px) * (24 * unit - py) - static_cast<Wide>(12 * unit - py) * (24 * unit - px);
      EXPECT_EQ(orient2d(p, {12, 12}, {24, 24}), sign_of(reference));
    }
}

TEST(Predicates, EveryPermutationIsConsistent) {
  Random random(5);
  for (int n = 0; n < 500; ++n) {
    Vec3 p[4];
    for (Vec3& q : p) q = {random.uniform(), random.uniform(), random.uniform()};
    p[3] = p[0] + 0.25 * (p[1] - p[0]) + 0.5 * (p[2] - p[0]);
    int order[4] = {0, 1, 2, 3};
    const int sign = orient3d(p[0], p[1], p[2], p[3]);
    do {
      int inversions = 0;
      for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) inversions += order[i] > order[j];
      EXPECT_EQ(orient3d(p[order[0]], p[order[1]], p[order[2]], p[order[3]]), inversions % 2 ? -sign : sign);
    } while (std::next_permutation(order, order + 4));
  }
}

}  // namespace
}  // namespace evenmesh
