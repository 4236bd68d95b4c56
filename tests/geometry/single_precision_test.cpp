#include "geometry/single_precision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace evenmesh {
namespace {

Mesh triangle_at(double x, double size) {
  return {{{x, 0, 0}, {x + size, 0, 0}, {x, size, 0}}, {{0, 1, 2}}};
}

TEST(SinglePrecision, FitsNearTheOriginAndNotFarAway) {
  EXPECT_TRUE(fits_single_precision(triangle_at(0.1, 0.01)));
  EXPECT_TRUE(fits_single_precision(triangle_at(100.1, 1)));
  EXPECT_FALSE(fits_single_precision(triangle_at(400000.1, 0.05)));
  EXPECT_TRUE(fits_single_precision(triangle_at(400000, 1))) << "floats hold these";
  EXPECT_FALSE(fits_single_precision(triangle_at(1, 1e39))) << "overflows";
  EXPECT_TRUE(fits_single_precision(Mesh{}));
}

TEST(SinglePrecision, DisplacementIsMeasuredInEdges) {
  const Mesh mesh = triangle_at(0, 1);
  std::vector<Vec3> moved = mesh.vertices;
  EXPECT_EQ(displacement(mesh, moved), 0);
  moved[0].z = 0.1;
  EXPECT_NEAR(displacement(mesh, moved), 0.1 / std::sqrt(2.0), 1e-12);
  moved[0].z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(displacement(mesh, moved), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace evenmesh
