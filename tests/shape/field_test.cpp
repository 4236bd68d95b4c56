// Properties that any formula must have: floats agree with doubles, gradients with differences, intervals enclose, and
// nothing depends on the processor or on where a point stands.

#include "shape/field.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "shape/fields.h"

namespace evenmesh {
namespace {

using testing::parse;
using testing::Points;
using testing::random_points;
using testing::value_at;

const Box cube{{-2, -2, -2}, {2, 2, 2}};

/// A random formula of bounded size whose value is a number nearly everywhere.
std::string random_formula(Random& random, int depth) {
  static const std::vector<std::string> leaves{"x", "y", "z", "r", "0.5", "2", "1.25"};
  if (depth == 0) return leaves[random.below(leaves.size())];
  const auto part = [&] { return random_formula(random, depth - 1); };
  switch (random.below(20)) {
    case 0:
      return "(" + part() + "+" + part() + ")";
    case 1:
      return "(" + part() + "-" + part() + ")";
    case 2:
      return "(" + part() + "*" + part() + ")";
    case 3:
      return "(" + part() + "/(1+(" + part() + ")^2))";
    case 4:
      return "sin(" + part() + ")";
    case 5:
      return "cos(" + part() + ")";
    case 6:
      return "min(" + part() + "," + part() + ")";
    case 7:
      return "max(" + part() + "," + part() + ")";
    case 8:
      return "abs(" + part() + ")";
    case 9:
      return "sqrt(abs(" + part() + ")+0.1)";
    case 10:
      return "exp(sin(" + part() + "))";
    case 11:
      return "log(1+abs(" + part() + "))";
    case 12:
      return "atan(" + part() + ")";
    case 13:
      return "atan2(" + part() + ",1+abs(" + part() + "))";
    case 14:
      return "(sin(" + part() + "))^3";
    case 15:
      return "(1+abs(" + part() + "))^0.7";
    case 16:
      return "asin(0.9sin(" + part() + "))";
    case 17:
      return "acos(0.9cos(" + part() + "))";
    case 18:
      return "mod(" + part() + ",1.5)";
    default:
      return "(3*" + part() + "-0.25*" + part() + "+1)";
  }
}

std::vector<std::string> random_formulas(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::string> formulas;
  for (int i = 0; i < count; ++i) formulas.push_back(random_formula(random, 1 + i % 5));
  return formulas;
}

TEST(ExpressionField, FloatsAgreeWithDoubles) {
  const Points points = random_points(cube, 600, 1);
  std::size_t compared = 0, apart = 0;
  for (const std::string& formula : random_formulas(200, 1)) {
    const auto field = parse(formula);
    const std::vector<float> values = testing::values_at(*field, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double exact = value_at(*field, points.at(i));
      if (!std::isfinite(exact) || std::abs(exact) > 1e3) continue;
      ++compared;
      apart += std::abs(values[i] - exact) > 1e-3 * (1 + std::abs(exact)) ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 100'000u);
  EXPECT_LT(apart, compared / 500) << "only jumps of mod may fall on different sides";
}

/// |computed − exact| over the largest of 1 and |exact| for f(x) at many points of [lo, hi].
double worst_error(const std::string& formula, double lo, double hi, double (*exact)(double)) {
  const Points points = random_points({{lo, 0, 0}, {hi, 1, 1}}, 20'000, 3);
  const std::vector<float> values = testing::values_at(*parse(formula), points);
  double worst = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double expected = exact(points.x[i]);
    worst = std::max(worst, std::abs(values[i] - expected) / std::max(1.0, std::abs(expected)));
  }
  return worst;
}

TEST(ExpressionField, FunctionsAreAccurate) {
  EXPECT_LT(worst_error("sin(x)", -10, 10, std::sin), 2e-7);
  EXPECT_LT(worst_error("cos(x)", -10, 10, std::cos), 2e-7);
  EXPECT_LT(worst_error("sin(x)", -1e4, 1e4, std::sin), 1e-6);
  EXPECT_LT(worst_error("cos(x)", -1e4, 1e4, std::cos), 1e-6);
  EXPECT_LT(worst_error("sin(x)", -1e7, 1e7, std::sin), 1e-6);
  EXPECT_LT(worst_error("cos(x)", -1e7, 1e7, std::cos), 1e-6);
  EXPECT_LT(worst_error("tan(x)", -1.4, 1.4, std::tan), 1e-6);
  EXPECT_LT(worst_error("exp(x)", -20, 80, std::exp), 5e-7);
  EXPECT_LT(worst_error("log(x)", 1e-6, 2, std::log), 3e-7);
  EXPECT_LT(worst_error("log(x)", 1e-6, 1e6, std::log), 3e-7);
  EXPECT_LT(worst_error("atan(x)", -5, 5, std::atan), 3e-7);
  EXPECT_LT(worst_error("asin(x)", -1, 1, std::asin), 3e-7);
  EXPECT_LT(worst_error("acos(x)", -1, 1, std::acos), 3e-7);
  EXPECT_LT(worst_error("x^1.7", 0, 100, [](double v) { return std::pow(v, 1.7); }), 3e-6);
}

TEST(ExpressionField, KnowsTheEndsOfTheFunctions) {
  const auto one = [](const std::string& formula, float x) {
    Points points(1);
    points.x[0] = x;
    return testing::values_at(*parse(formula), points)[0];
  };
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(one("log(x)", 0.0f), -infinity);
  EXPECT_TRUE(std::isnan(one("log(x)", -1.0f)));
  EXPECT_EQ(one("log(x)", infinity), infinity);
  EXPECT_NEAR(one("log(x)", 1e-42f), std::log(1e-42), 0.1);
  EXPECT_EQ(one("exp(x)", 100.0f), infinity);
  EXPECT_EQ(one("exp(x)", -200.0f), 0.0f);
  EXPECT_TRUE(std::isnan(one("exp(x)", std::nanf(""))));
  EXPECT_TRUE(std::isnan(one("sin(x)", infinity)));
  EXPECT_TRUE(std::isnan(one("asin(x)", 1.5f)));
  EXPECT_TRUE(std::isnan(one("sqrt(x)", -1.0f)));
  EXPECT_EQ(one("x^0.3", 0.0f), 0.0f);
  EXPECT_EQ(one("x^y", 0.0f), 1.0f);
  EXPECT_FLOAT_EQ(one("atan2(y, x)", -1.0f), 3.14159265f);
  EXPECT_EQ(one("atan2(y, x)", 0.0f), 0.0f);
}

TEST(ExpressionField, GradientsAgreeWithEachOtherAndWithDifferences) {
  const Points points = random_points(cube, 50, 5);
  std::size_t compared = 0, apart_float = 0, apart_difference = 0;
  for (const std::string& formula : random_formulas(200, 2)) {
    const auto field = parse(formula);
    const testing::Gradients floats = testing::gradients_at(*field, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vec3 exact, difference;
      const double value = field->evaluate(points.at(i), &exact), step = 1e-6;
      if (!std::isfinite(value) || !is_finite(exact) || norm(exact) > 1e3) continue;
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 above = points.at(i), below = above;
        above[axis] += step, below[axis] -= step;
        difference[axis] = (value_at(*field, above) - value_at(*field, below)) / (2 * step);
      }
      ++compared;
      apart_float += norm(floats.at(i) - exact) > 1e-2 * (1 + norm(exact)) ? 1 : 0;
      apart_difference += norm(difference - exact) > 1e-3 * (1 + norm(exact)) ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 8'000u);
  EXPECT_LT(apart_float, compared / 200) << "only kinks and jumps may be taken differently";
  EXPECT_LT(apart_difference, compared / 200);
}

TEST(ExpressionField, GradientIsThatOfTheBranchTakenAndFiniteAtTheOrigin) {
  Vec3 g;
  parse("max(abs(x),abs(y),abs(z)) - 1")->evaluate(Vec3{0.2, -0.9, 0.3}, &g);
  EXPECT_EQ(g, (Vec3{0, -1, 0}));
  Points origin(1);
  for (const char* formula : {"r", "sqrt(x)", "x/r", "atan2(y,x)", "log(x)", "x^0.5", "abs(x)+r"}) {
    const testing::Gradients gradients = testing::gradients_at(*parse(formula), origin);
    EXPECT_TRUE(formula == std::string("x/r") || is_finite(gradients.at(0))) << formula;
  }
}

TEST(ExpressionField, ValuesOfBothEvaluationsAreTheSameBits) {
  const Points points = random_points(cube, 1000, 9);
  for (const std::string& formula : random_formulas(50, 3)) {
    const auto field = parse(formula);
    const std::vector<float> values = testing::values_at(*field, points);
    const testing::Gradients gradients = testing::gradients_at(*field, points);
    EXPECT_EQ(std::memcmp(values.data(), gradients.values.data(), values.size() * sizeof(float)), 0) << formula;
  }
}

TEST(ExpressionField, PlaceInTheBatchDoesNotMatter) {
  const Points points = random_points(cube, 1111, 11);
  for (const std::string& formula : random_formulas(30, 4)) {
    const auto field = parse(formula);
    const testing::Gradients all = testing::gradients_at(*field, points);
    for (const std::size_t size : {1u, 3u, 17u, 64u, 600u}) {
      const std::size_t begin = 1111 % size;
      const auto piece = [&](const std::vector<float>& v) { return std::span<const float>(v).subspan(begin, size); };
      testing::Gradients some(size);
      field->evaluate_gradient(PointBatch{piece(points.x), piece(points.y), piece(points.z)}, some.values, some.dx,
                               some.dy, some.dz);
      EXPECT_EQ(std::memcmp(some.values.data(), &all.values[begin], size * sizeof(float)), 0) << formula;
      EXPECT_EQ(std::memcmp(some.dz.data(), &all.dz[begin], size * sizeof(float)), 0) << formula;
    }
  }
}

/// Everything once per instruction set that this processor has.
TEST(ExpressionField, EveryInstructionSetGivesTheSameBits) {
  std::vector<std::string> formulas = random_formulas(60, 5);
  for (const GalleryEntry& entry : gallery()) formulas.push_back("gallery:" + std::string(entry.name));
  const Points points = random_points({{-30, -3, -2}, {30, 2, 3}}, 533, 13);
  for (const std::string& formula : formulas) {
    const auto field =
        formula.starts_with("gallery:") ? testing::field_of(gallery_shape(formula.substr(8))) : parse(formula);
    const testing::Gradients expected = testing::gradients_at(*field, points);
    for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
      const std::int64_t target = targets & -targets;
      if (target == HWY_EMU128 || target == HWY_SCALAR) continue;
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      const testing::Gradients found = testing::gradients_at(*field, points);
      hwy::SetSupportedTargetsForTest(0);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      const auto same = [](const std::vector<float>& a, const std::vector<float>& b) {
        for (std::size_t i = 0; i < a.size(); ++i)
          if (a[i] != b[i] && !(std::isnan(a[i]) && std::isnan(b[i]))) return false;
        return true;
      };
      EXPECT_TRUE(same(expected.values, found.values)) << formula << " on " << hwy::TargetName(target);
      EXPECT_TRUE(same(expected.dx, found.dx)) << formula << " on " << hwy::TargetName(target);
    }
  }
}

TEST(ExpressionField, IntervalsEnclose) {
  Random random(17);
  for (const std::string& formula : random_formulas(300, 6)) {
    const auto field = parse(formula);
    for (int round = 0; round < 5; ++round) {
      const Box box = testing::random_box(cube, random);
      const Interval interval = field->evaluate(box);
      ASSERT_LE(interval.lo, interval.hi) << formula;
      const Points points = random_points(box, 40, random.bits());
      const std::vector<float> values = testing::values_at(*field, points);
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::isnan(values[i])) continue;
        EXPECT_GE(values[i], interval.lo) << formula;
        EXPECT_LE(values[i], interval.hi) << formula;
        const double exact = value_at(*field, points.at(i));
        EXPECT_GE(exact, interval.lo) << formula;
        EXPECT_LE(exact, interval.hi) << formula;
      }
    }
  }
}

/// Formulas that leave the domain of a function: not a number must never pass for inside.
TEST(ExpressionField, IntervalsAllowForUndefinedValues) {
  Random random(19);
  for (const char* formula :
       {"sqrt(x)-3",  "log(y)-9",      "asin(2x)-4",          "acos(x+y)-9",       "x^0.3-5",    "1/x",
        "x/(y*z)",    "tan(3x)",       "max(sqrt(x)-3, y-9)", "min(sqrt(x), y)",   "mod(x,y)",   "x^y",
        "atan2(y,x)", "sign(sqrt(x))", "floor(1/x)",          "exp(40x)-exp(41y)", "x*exp(99y)", "log(abs(x))*0",
        "-sqrt(-1)",  "(x-9)/0"}) {
    const auto field = parse(formula);
    for (int round = 0; round < 30; ++round) {
      const Box box = testing::random_box(cube, random);
      const Interval interval = field->evaluate(box);
      const Points points = random_points(box, 50, random.bits());
      const std::vector<float> values = testing::values_at(*field, points);
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::isnan(values[i]))
          EXPECT_GE(interval.hi, 0) << formula;
        else
          EXPECT_TRUE(values[i] >= interval.lo && values[i] <= interval.hi) << formula << " " << values[i];
      }
    }
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
    const Box box = testing::random_box(cube, random);
    const auto special = field->specialized(box);
    if (!special) continue;
    ++shorter;
    const Points points = random_points(box, 100, random.bits());
    const std::vector<float> a = testing::values_at(*field, points), b = testing::values_at(*special, points);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(a[i] == b[i] || std::isnan(a[i]));
  }
  EXPECT_GT(shorter, 50);
  EXPECT_EQ(parse("x^2+y^2-1")->specialized(cube), nullptr);
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
  const Points points = random_points(cube, 700, 29);
  const testing::Gradients g = testing::gradients_at(field, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(g.dx[i], points.y[i], 2e-2);
    EXPECT_NEAR(g.dy[i], points.x[i], 2e-2);
    EXPECT_NEAR(g.dz[i], 3, 2e-2);
  }
  Vec3 gradient;
  EXPECT_NEAR(field.evaluate(Vec3{1, 2, 3}, &gradient), 11, 1e-6);
  EXPECT_NEAR(norm(gradient - Vec3{2, 1, 3}), 0, 0.05);
  EXPECT_EQ(field.evaluate(cube).lo, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(field.specialized(cube), nullptr);
  EXPECT_EQ(field.batch_size(), 1024u);
  const std::vector<Box> boxes(3, cube);
  std::vector<Interval> ranges(3);
  field.enclose(boxes, ranges);
  EXPECT_EQ(ranges[2].hi, std::numeric_limits<double>::infinity());
}

TEST(Field, DifferentiatesInFewCallsWithTheSameBits) {
  const Points points = random_points(cube, 1200, 31);
  const testing::Gradients a = testing::gradients_at(Bare{}, points);
  const Batched batched;
  const testing::Gradients b = testing::gradients_at(batched, points);
  EXPECT_TRUE(a.values == b.values && a.dx == b.dx && a.dy == b.dy && a.dz == b.dz);
  EXPECT_EQ(batched.calls, 3);
}

}  // namespace
}  // namespace evenmesh
