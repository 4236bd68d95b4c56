#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.h"
#include "evenmesh/error.h"
#include "grid/morton.h"
#include "grid/sample_set.h"

namespace evenmesh {
namespace {

TEST(Grid, CoversTheBoundsWithTwoCellsOfMargin) {
  for (const std::size_t resolution : {1, 7, 256, 8192}) {
    const Box box{{-1, 2, 100}, {3, 2.5, 101}};
    const Grid grid = make_grid(box, resolution);
    EXPECT_DOUBLE_EQ(grid.spacing, 4.0 / double(resolution));
    for (int a = 0; a < 3; ++a) {
      const std::uint32_t n = grid.size[std::size_t(a)];
      EXPECT_LE(n, 8200u);
      EXPECT_GE((box.lo[a] - grid.origin[a]) / grid.spacing, 2.0 - 1e-9);
      EXPECT_GE(grid.point(n - 1.0, n - 1.0, n - 1.0)[a] - box.hi[a], (2.0 - 1e-9) * grid.spacing);
    }
  }
}

TEST(Grid, RefusesWhatHasNoSize) {
  EXPECT_THROW(make_grid(Box{}, 10), InvalidInput);
  EXPECT_THROW(make_grid(Box{{1, 1, 1}, {1, 1, 1}}, 10), InvalidInput);
  EXPECT_THROW(make_grid(Box{{0, 0, 0}, {1, std::numeric_limits<double>::infinity(), 1}}, 10), InvalidInput);
  EXPECT_THROW(make_grid(Box{{0, 0, 0}, {1, 1, 1}}, 0), InvalidInput);
  EXPECT_THROW(make_grid(Box{{0, 0, 0}, {1, 1, 1}}, 8193), InvalidInput);
}

TEST(Grid, FlatBoundsAreFine) {
  const Grid grid = make_grid(Box{{0, 0, 0}, {1, 1, 0}}, 10);
  EXPECT_GE(grid.size[2], 5u);
}

TEST(PackedNormal, ErrorIsBelow7e5) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 n = normalized({random.gaussian(), random.gaussian(), random.gaussian()});
    EXPECT_LT(norm(unpack_normal(pack_normal(n)) - n), 7e-5);
  }
}

TEST(PackedNormal, AxesAreExact) {
  for (int a = 0; a < 3; ++a)
    for (const double s : {-1.0, 1.0}) {
      Vec3 n;
      n[a] = s;
      EXPECT_LT(norm(unpack_normal(pack_normal(n)) - n), 1e-12);
    }
}

TEST(Morton, DecodesWhatItEncodes) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const auto x = random.below(8192), y = random.below(8192), z = random.below(8192);
    const auto back = morton_decode(morton_code(x, y, z));
    EXPECT_EQ(back[0], x);
    EXPECT_EQ(back[1], y);
    EXPECT_EQ(back[2], z);
  }
  EXPECT_EQ(morton_code(1, 0, 0), 1u);
  EXPECT_EQ(morton_code(0, 1, 0), 2u);
  EXPECT_EQ(morton_code(0, 0, 3), 36u);
}

}  // namespace
}  // namespace evenmesh
