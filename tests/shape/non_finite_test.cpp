#include "shape/non_finite.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "evenmesh/solid.h"
#include "shape/field.h"

namespace evenmesh {
namespace {

/// √x − 1: not a number where x < 0.
class Root final : public Field {
 public:
  void evaluate(const PointBatch& points, std::span<float> values) const override {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = std::sqrt(points.x[i]) - 1;
      if (!std::isfinite(values[i])) ++count_;
    }
  }
  const std::atomic<std::size_t>* non_finite_counter() const override { return &count_; }

 private:
  mutable std::atomic<std::size_t> count_{0};
};

Shape root() {
  return {"root", Box{{-2, -2, -2}, {2, 2, 2}}, std::make_shared<const Root>(), true};
}

void evaluate(const Shape& shape, std::vector<float> x) {
  std::vector<float> zeros(x.size()), values(x.size());
  shape.field()->evaluate(PointBatch{x, zeros, zeros}, values);
}

TEST(NonFiniteValues, OfOneComputationAreCountedFromItsBeginning) {
  const Shape shape = root();
  for (int run = 0; run < 3; ++run) {
    const NonFiniteValues values(shape);
    EXPECT_EQ(values.count(), 0u);
    evaluate(shape, {-1, 1, -2});
    EXPECT_EQ(values.count(), 2u) << "run " << run;
  }
  EXPECT_EQ(shape.field()->non_finite(), 6u) << "the field itself counts for ever";
}

TEST(NonFiniteValues, OfOperandsAreCountedOnce) {
  const Shape shape = root();
  const Shape moved = transformed(shape, Affine::translate({0.5, 0, 0}));  // the same counter
  const NonFiniteValues values(unite({shape, offset(moved, 0.1), gallery_shape("sphere")}));
  evaluate(shape, {-1});
  evaluate(moved, {0.25, 1});
  EXPECT_EQ(values.count(), 2u);
}

TEST(NonFiniteValues, OfShapesThatDoNotCountAreNone) {
  EXPECT_EQ(NonFiniteValues(gallery_shape("sphere")).count(), 0u);
  EXPECT_EQ(NonFiniteValues(shape_from_box({{0, 0, 0}, {1, 1, 1}})).count(), 0u);
}

TEST(DensityFromExpression, RemembersItsText) {
  const Density density = density_from_expression("1 + a x", {{"a", 2}});
  const Density copy = density;
  EXPECT_EQ(expression_of(copy), (DensityExpression{"1 + a x", {{"a", 2}}}));
  EXPECT_EQ(copy({3, 0, 0}), 7);
  EXPECT_EQ(expression_of({}), std::nullopt);
  EXPECT_EQ(expression_of([](const Vec3&) { return 1.0; }), std::nullopt);
}

}  // namespace
}  // namespace evenmesh
