#include "shape/local_origin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "evenmesh/solid.h"
#include "shape/bounds.h"
#include "shape/field.h"

namespace evenmesh {
namespace {

const Vec3 far_place{400000.5, 5000000.25, -3};
const Box unit{{-1, -1, -1}, {1, 1, 1}};

Box around(const Vec3& middle, double half) {
  return {middle - half * Vec3{1, 1, 1}, middle + half * Vec3{1, 1, 1}};
}

/// Largest difference of batch values from those of a ball with the radius, over its surface and somewhat beyond.
double ball_error(const Shape& counted, const Vec3& middle, double radius) {
  std::vector<float> x, y, z;
  for (int i = 0; i < 200; ++i) {
    x.push_back(static_cast<float>(middle.x + std::cos(0.1 * i)));
    y.push_back(static_cast<float>(middle.y + std::sin(0.1 * i)));
    z.push_back(static_cast<float>(middle.z + 0.001 * i));
  }
  std::vector<float> values(x.size());
  counted.field()->evaluate(PointBatch{x, y, z}, values);
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double exact = squared_norm(Vec3{x[i], y[i], z[i]} - middle) - radius * radius;
    worst = std::max(worst, std::abs(values[i] - exact));
  }
  return worst;
}

TEST(LocalOrigin, IsZeroNearTheOriginAndNearTheBoxFarAway) {
  EXPECT_EQ(local_origin(unit), Vec3{});
  EXPECT_EQ(local_origin(around({5, 0, 0}, 1)), Vec3{});
  EXPECT_EQ(local_origin(Box{}), Vec3{});
  const Vec3 origin = local_origin(around(far_place, 1));
  EXPECT_EQ(origin.z, 0) << "near along this axis";
  EXPECT_LE(std::abs(origin.x - far_place.x), 2);
  EXPECT_LE(std::abs(origin.y - far_place.y), 2);
  EXPECT_EQ(std::fmod(origin.x, 2), 0) << "taking it away does not round";
}

TEST(LocalOrigin, FieldsStayPrecise) {
  const std::string ball = "(x - 400000.5)^2 + (y - 5000000.25)^2 + (z + 3)^2 - 1";
  const Box bounds = around(far_place, 2);
  const Shape written = shape_from_expression(ball, {}, bounds);
  Shape moved = transformed(shape_from_expression("x^2 + y^2 + z^2 - 1", {}, {}), Affine::translate(far_place));
  moved.bounds = bounds;
  const Shape indicator = shape_from_indicator([](const Vec3& p) { return norm(p - far_place) < 1; }, bounds);
  const Vec3 origin = local_origin(bounds);
  for (const Shape& shape : {written, moved}) {
    const Shape counted = counted_from(origin, shape);
    EXPECT_LT(ball_error(counted, far_place - origin, 1), 2e-5);
    EXPECT_EQ(rounding_of(counted, origin), 0);
    EXPECT_EQ(counted.bounds.center() + origin, bounds.center());
  }
  EXPECT_EQ(rounding_of(counted_from(origin, indicator), origin), 0);
}

TEST(LocalOrigin, SaysWhatOnlySinglePrecisionKnows) {
  class Coarse final : public Field {
    void evaluate(const PointBatch& points, std::span<float> values) const override {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = points.x[i] - 400000;
    }
  };
  const Box bounds = around(far_place, 2);
  const Shape shape{"coarse", bounds, std::make_shared<const Coarse>(), true};
  const Vec3 origin = local_origin(bounds);
  EXPECT_NEAR(rounding_of(counted_from(origin, shape), origin), 5000002 * std::exp2(-24), 1e-6);
  EXPECT_EQ(rounding_of(Shape{"near", unit, shape.what, true}, {}), 0);
}

TEST(LocalOrigin, OfMeshesPointsAndCompounds) {
  const Shape box = shape_from_box(around(far_place, 1));
  const Vec3 origin = local_origin(box.bounds);
  const Shape counted = counted_from(origin, unite({box, shape_from_box(around(far_place, 0.5))}));
  EXPECT_EQ(counted.bounds.lo + origin, box.bounds.lo);
  const Shape& operand = counted.compound()->operands[0];
  EXPECT_EQ(operand.mesh()->bounds(), operand.bounds);
  EXPECT_EQ(operand.bounds.hi + origin, box.bounds.hi);
  const Shape points = counted_from(origin, shape_from_points({{far_place}, {}}));
  EXPECT_EQ(points.points()->points[0] + origin, far_place);
}

TEST(LocalOrigin, BoundsAreFoundBeyondAMillion) {
  const Box box = find_bounds(shape_from_expression("(x - 4000000)^2 + y^2 + z^2 - 10000"));
  EXPECT_TRUE(box.contains({3999900, 0, 0}));
  EXPECT_LT(box.longest_side(), 400);
}

}  // namespace
}  // namespace evenmesh
