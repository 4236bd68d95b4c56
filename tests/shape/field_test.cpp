// What fields on the CPU have besides the properties of field_checks.h: the same bits on every processor, narrow
// intervals, shorter code for boxes; and what the base class does for those that have nothing but values.

#include "shape/field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/instruction_sets.h"
#include "shape/field_checks.h"

namespace evenmesh {
namespace testing {

INSTANTIATE_TEST_SUITE_P(Expression, FieldForms, ::testing::Values(on_cpu), name_of_form);
INSTANTIATE_TEST_SUITE_P(Expression, TapeForms, ::testing::Values(on_cpu), name_of_form);

}  // namespace testing
namespace {

using testing::parse;
using testing::Points;
using testing::random_formula;
using testing::random_formulas;
using testing::random_points;
using testing::value_at;
using testing::wide_cube;

TEST(ExpressionField, EveryInstructionSetGivesTheSameBits) {
  std::vector<std::string> formulas = random_formulas(60, 5);
  for (const GalleryEntry& entry : gallery()) formulas.push_back("gallery:" + std::string(entry.name));
  const Points points = random_points({{-30, -3, -2}, {30, 2, 3}}, 533, 13);
  for (const std::string& formula : formulas) {
    const auto field =
        formula.starts_with("gallery:") ? testing::field_of(gallery_shape(formula.substr(8))) : parse(formula);
    const testing::Gradients expected = testing::gradients_at(*field, points);
    on_every_instruction_set([&](const char* target) {
      const testing::Gradients found = testing::gradients_at(*field, points);
      const auto same = [](const std::vector<float>& a, const std::vector<float>& b) {
        for (std::size_t i = 0; i < a.size(); ++i)
          if (a[i] != b[i] && !(std::isnan(a[i]) && std::isnan(b[i]))) return false;
        return true;
      };
      EXPECT_TRUE(same(expected.values, found.values)) << formula << " on " << target;
      EXPECT_TRUE(same(expected.dx, found.dx)) << formula << " on " << target;
    });
  }
}

TEST(ExpressionField, IntervalsOfNarrowBoxesAreNarrow) {
  for (const std::string formula : {"x^2+y^2+z^2+sin(4x)-cos(4y)+sin(4z)", "exp(x)*log(3+y)/(2+z)", "atan2(y,3+x)+r",
                                    "mod(x+0.25,1)", "(2+x)^1.3"}) {
    const Vec3 center{0.3, 0.4, -0.2}, half{1e-3, 1e-3, 1e-3};
    const Interval interval = parse(formula)->evaluate(Box{center - half, center + half});
    EXPECT_LT(interval.hi - interval.lo, 0.1) << formula;
  }
}

TEST(ExpressionField, SpecializedFieldsHaveTheSameBits) {
  Random random(23);
  int shorter = 0;
  for (int round = 0; round < 300; ++round) {
    const auto field = parse("max(" + random_formula(random, 4) + ",abs(" + random_formula(random, 3) + ")-0.5)");
    const Box box = testing::random_box(wide_cube, random);
    const auto special = field->specialized(box);
    if (!special) continue;
    ++shorter;
    const Points points = random_points(box, 100, random.bits());
    const std::vector<float> a = testing::values_at(*field, points), b = testing::values_at(*special, points);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(a[i] == b[i] || std::isnan(a[i]));
  }
  EXPECT_GT(shorter, 50);
  EXPECT_EQ(parse("x^2+y^2-1")->specialized(wide_cube), nullptr);
}

/// A field that has nothing but values, for the defaults of the base class.
class Bare : public Field {
 public:
  using Field::evaluate;
  void evaluate(const PointBatch& points, std::span<float> values) const override {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = points.x[i] * points.y[i] + 3 * points.z[i];
  }
};

/// The same, asked as seldom as possible.
class Batched final : public Bare {
 public:
  using Field::evaluate;
  void evaluate(const PointBatch& points, std::span<float> values) const override {
    ++calls;
    Bare::evaluate(points, values);
  }
  std::size_t batch_size() const override { return 7 * 500; }
  mutable int calls = 0;
};

TEST(Field, DefaultsDifferentiateAndKnowNothingElse) {
  const Bare field;
  const Points points = random_points(wide_cube, 700, 29);
  const testing::Gradients g = testing::gradients_at(field, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(g.dx[i], points.y[i], 2e-2);
    EXPECT_NEAR(g.dy[i], points.x[i], 2e-2);
    EXPECT_NEAR(g.dz[i], 3, 2e-2);
  }
  Vec3 gradient;
  EXPECT_NEAR(field.evaluate(Vec3{1, 2, 3}, &gradient), 11, 1e-6);
  EXPECT_NEAR(norm(gradient - Vec3{2, 1, 3}), 0, 0.05);
  EXPECT_EQ(field.evaluate(wide_cube).lo, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(field.specialized(wide_cube), nullptr);
  EXPECT_EQ(field.batch_size(), 1024u);
  const std::vector<Box> boxes(3, wide_cube);
  std::vector<Interval> ranges(3);
  field.enclose(boxes, ranges);
  EXPECT_EQ(ranges[2].hi, std::numeric_limits<double>::infinity());
}

TEST(Field, DifferentiatesInFewCallsWithTheSameBits) {
  const Points points = random_points(wide_cube, 1200, 31);
  const testing::Gradients a = testing::gradients_at(Bare{}, points);
  const Batched batched;
  const testing::Gradients b = testing::gradients_at(batched, points);
  EXPECT_TRUE(a.values == b.values && a.dx == b.dx && a.dy == b.dy && a.dz == b.dz);
  EXPECT_EQ(batched.calls, 3);
}

}  // namespace
}  // namespace evenmesh
