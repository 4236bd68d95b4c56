/// Boxes around expressions that interval arithmetic alone does not find.

#include <gtest/gtest.h>

#include <string>

#include "evenmesh/error.h"
#include "evenmesh/shape.h"
#include "shape/bounds.h"

namespace evenmesh {
namespace {

void expect_box(const std::string& formula, const Box& expected) {
  const Box box = find_bounds(shape_from_expression(formula));
  const double room = 0.1 * expected.longest_side();
  EXPECT_TRUE(box.contains(expected.lo) && box.contains(expected.hi)) << formula;
  EXPECT_TRUE((Box{expected.lo - Vec3{room, room, room}, expected.hi + Vec3{room, room, room}}).contains(box.lo));
  EXPECT_TRUE((Box{expected.lo - Vec3{room, room, room}, expected.hi + Vec3{room, room, room}}).contains(box.hi));
}

TEST(ExpressionBounds, OfQuotientsThatPassThroughZero) {
  expect_box("max(abs(x/(1-z/3))-1, abs(y/(1-z/3))-1, abs(z-1.5)-1.5)", {{-1, -1, 0}, {1, 1, 3}});
  expect_box("max((x^2+y^2)/(2-z)^2 - 1, abs(z)-2)", {{-4, -4, -2}, {4, 4, 2}});
}

TEST(ExpressionBounds, NothingUnboundedPasses) {
  for (const char* formula : {"1/x", "x/y", "min(r-1, 100000-z)", "max(abs(x/(1-z/3))-1, abs(y)-1)", "x^2+y^2-1"})
    EXPECT_THROW(find_bounds(shape_from_expression(formula)), UnusableInput) << formula;
}

}  // namespace
}  // namespace evenmesh
