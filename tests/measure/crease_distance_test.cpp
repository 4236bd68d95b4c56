#include <gtest/gtest.h>

#include "evenmesh/measure.h"
#include "geometry/primitives.h"

namespace evenmesh {
namespace {

const CompareOptions few{.samples = 1000};

TEST(CreaseDistance, OfABoxFromItselfIsNoneAndItsLengthIsThatOfItsEdges) {
  const MeshDistance d = compare_meshes(make_box({1, 1, 1}, 5), make_box(), few);
  EXPECT_NEAR(d.crease_length, 24, 1e-12);
  EXPECT_NEAR(d.crease_max, 0, 1e-12);
  EXPECT_NEAR(d.crease_avg, 0, 1e-12);
}

TEST(CreaseDistance, OfAShiftedBoxIsTheShiftWhereEdgesAreAcrossIt) {
  // Eight of twelve edges are across the shift, where corners come nearer to the edges along it by rounding only.
  const MeshDistance d = compare_meshes(translated(make_box(), {0.1, 0, 0}), make_box(), few);
  EXPECT_NEAR(d.crease_max, 0.1, 1e-9);
  EXPECT_GT(d.crease_avg, 0.06);
  EXPECT_LT(d.crease_avg, 0.08);
}

TEST(CreaseDistance, IsInfiniteToASmoothMeshAndNoneFromIt) {
  EXPECT_TRUE(std::isinf(compare_meshes(make_icosphere(3), make_box(), few).crease_max));
  const MeshDistance d = compare_meshes(make_box(), make_icosphere(3), few);
  EXPECT_EQ(d.crease_length, 0);
  EXPECT_EQ(d.crease_max, 0);
}

}  // namespace
}  // namespace evenmesh
