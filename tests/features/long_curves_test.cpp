#include "features/long_curves.h"

#include <gtest/gtest.h>

namespace evenmesh {
namespace {

TEST(LongCurves, KeepTheirCorners) {
  FeatureCurves all;
  all.corners = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  all.curves = {{0, 1, {{0, 0, 0}, {1, 0, 0}}, {0, 1}}, {1, 2, {{1, 0, 0}, {3, 0, 0}}, {0, 2}}};
  const FeatureCurves kept = long_curves(all, 1.5);
  ASSERT_EQ(kept.curves.size(), 1u);
  ASSERT_EQ(kept.corners.size(), 2u);
  EXPECT_EQ(kept.corners[kept.curves[0].from], (Vec3{1, 0, 0}));
  EXPECT_EQ(kept.corners[kept.curves[0].to], (Vec3{3, 0, 0}));
  EXPECT_EQ(long_curves(all, 0).curves.size(), 2u);
  EXPECT_TRUE(long_curves(all, 9).corners.empty());
}

}  // namespace
}  // namespace evenmesh
