#pragma once
/// Properties that any formula must have, in whatever form: floats agree with doubles, gradients with differences,
/// intervals enclose, and nothing depends on where a point stands.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "shape/fields.h"
#include "shape/forms.h"
#include "shape/formulas.h"

namespace evenmesh::testing {

/// Forms with values and gradients.
class FieldForms : public FormTest {
 protected:
  std::shared_ptr<const Field> field(std::string_view text) const { return GetParam().field(text); }
  std::vector<std::string> some(const std::vector<std::string>& formulas) const { return GetParam().some(formulas); }
};

/// Forms that differentiate, and enclose values in intervals.
class TapeForms : public FieldForms {};

TEST_P(FieldForms, FloatsAgreeWithDoubles) {
  const Points points = random_points(wide_cube, 600, 1);
  std::size_t compared = 0, apart = 0;
  const auto formulas = some(random_formulas(200, 1));
  for (const std::string& formula : formulas) {
    const auto doubles = parse(formula);
    const std::vector<float> values = values_at(*field(formula), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double exact = value_at(*doubles, points.at(i));
      if (!std::isfinite(exact) || std::abs(exact) > 1e3) continue;
      ++compared;
      apart += std::abs(values[i] - exact) <= 1e-3 * (1 + std::abs(exact)) ? 0 : 1;
    }
  }
  EXPECT_GT(compared, 500u * formulas.size());
  EXPECT_LT(apart, compared / 500) << "only jumps of mod may fall on different sides";
}

/// |computed − exact| over the largest of 1 and |exact| for f(x) at many points of [lo, hi].
inline double worst_error(const Field& field, double lo, double hi, double (*exact)(double)) {
  const Points points = random_points({{lo, 0, 0}, {hi, 1, 1}}, 20'000, 3);
  const std::vector<float> values = values_at(field, points);
  double worst = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double expected = exact(points.x[i]);
    const double error = std::abs(values[i] - expected) / std::max(1.0, std::abs(expected));
    worst = std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(worst, error);
  }
  return worst;
}

TEST_P(FieldForms, FunctionsAreAccurate) {
  EXPECT_LT(worst_error(*field("sin(x)"), -10, 10, std::sin), 2e-7);
  EXPECT_LT(worst_error(*field("cos(x)"), -10, 10, std::cos), 2e-7);
  EXPECT_LT(worst_error(*field("sin(x)"), -1e4, 1e4, std::sin), 1e-6);
  EXPECT_LT(worst_error(*field("cos(x)"), -1e4, 1e4, std::cos), 1e-6);
  EXPECT_LT(worst_error(*field("sin(x)"), -1e7, 1e7, std::sin), 1e-6);
  EXPECT_LT(worst_error(*field("cos(x)"), -1e7, 1e7, std::cos), 1e-6);
  EXPECT_LT(worst_error(*field("tan(x)"), -1.4, 1.4, std::tan), 1e-6);
  EXPECT_LT(worst_error(*field("exp(x)"), -20, 80, std::exp), 5e-7);
  EXPECT_LT(worst_error(*field("log(x)"), 1e-6, 2, std::log), 3e-7);
  EXPECT_LT(worst_error(*field("log(x)"), 1e-6, 1e6, std::log), 3e-7);
  EXPECT_LT(worst_error(*field("atan(x)"), -5, 5, std::atan), 3e-7);
  EXPECT_LT(worst_error(*field("asin(x)"), -1, 1, std::asin), 3e-7);
  EXPECT_LT(worst_error(*field("acos(x)"), -1, 1, std::acos), 3e-7);
  EXPECT_LT(worst_error(*field("x^1.7"), 0, 100, [](double v) { return std::pow(v, 1.7); }), 3e-6);
}

TEST_P(FieldForms, KnowsTheEndsOfTheFunctions) {
  const auto one = [&](const std::string& formula, float x) {
    Points points(1);
    points.x[0] = x;
    return values_at(*field(formula), points)[0];
  };
  const float infinity = std::numeric_limits<float>::infinity();
  const float log_0 = one("log(x)", 0.0f);
  EXPECT_TRUE(GetParam().keeps_infinities ? log_0 == -infinity : std::isnan(log_0)) << log_0;
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

TEST_P(FieldForms, GradientsAgreeWithEachOtherAndWithDifferences) {
  const Points points = random_points(wide_cube, 50, 5);
  std::size_t compared = 0, apart_float = 0, apart_difference = 0;
  const auto formulas = some(random_formulas(200, 2));
  for (const std::string& formula : formulas) {
    const auto doubles = parse(formula);
    const Gradients floats = gradients_at(*field(formula), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vec3 exact, difference;
      const double value = doubles->evaluate(points.at(i), &exact), step = 1e-6;
      if (!std::isfinite(value) || !is_finite(exact) || norm(exact) > 1e3) continue;
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 above = points.at(i), below = above;
        above[axis] += step, below[axis] -= step;
        difference[axis] = (value_at(*doubles, above) - value_at(*doubles, below)) / (2 * step);
      }
      ++compared;
      apart_float += norm(floats.at(i) - exact) <= 1e-2 * (1 + norm(exact)) ? 0 : 1;
      apart_difference += norm(difference - exact) > 1e-3 * (1 + norm(exact)) ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 40u * formulas.size());
  EXPECT_LT(apart_float, compared / 200) << "only kinks and jumps may be taken differently";
  EXPECT_LT(apart_difference, compared / 200);
}

TEST_P(TapeForms, GradientIsThatOfTheBranchTakenAndFiniteAtTheOrigin) {
  Vec3 g;
  field("max(abs(x),abs(y),abs(z)) - 1")->evaluate(Vec3{0.2, -0.9, 0.3}, &g);
  EXPECT_EQ(g, (Vec3{0, -1, 0}));
  Points origin(1);
  for (const char* formula : {"r", "sqrt(x)", "x/r", "atan2(y,x)", "log(x)", "x^0.5", "abs(x)+r"}) {
    const Gradients gradients = gradients_at(*field(formula), origin);
    EXPECT_TRUE(formula == std::string("x/r") || is_finite(gradients.at(0))) << formula;
  }
}

TEST_P(FieldForms, ValuesOfBothEvaluationsAreTheSameBits) {
  const Points points = random_points(wide_cube, 1000, 9);
  for (const std::string& formula : some(random_formulas(50, 3))) {
    const auto made = field(formula);
    const std::vector<float> values = values_at(*made, points);
    const Gradients gradients = gradients_at(*made, points);
    EXPECT_EQ(std::memcmp(values.data(), gradients.values.data(), values.size() * sizeof(float)), 0) << formula;
  }
}

TEST_P(FieldForms, PlaceInTheBatchDoesNotMatter) {
  const Points points = random_points(wide_cube, 6000, 11);
  for (const std::string& formula : some(random_formulas(30, 4))) {
    const auto made = field(formula);
    const Gradients all = gradients_at(*made, points);
    for (const std::size_t size : {1u, 3u, 17u, 64u, 600u, 4500u}) {
      const std::size_t begin = 1111 % size;
      const auto piece = [&](const std::vector<float>& v) { return std::span<const float>(v).subspan(begin, size); };
      Gradients some(size);
      made->evaluate_gradient(PointBatch{piece(points.x), piece(points.y), piece(points.z)}, some.values, some.dx,
                              some.dy, some.dz);
      EXPECT_EQ(std::memcmp(some.values.data(), &all.values[begin], size * sizeof(float)), 0) << formula;
      EXPECT_EQ(std::memcmp(some.dz.data(), &all.dz[begin], size * sizeof(float)), 0) << formula;
    }
  }
}

TEST_P(TapeForms, IntervalsEnclose) {
  Random random(17);
  for (const std::string& formula : some(random_formulas(300, 6))) {
    const auto made = field(formula);
    for (int round = 0; round < 5; ++round) {
      const Box box = random_box(wide_cube, random);
      const Interval interval = made->evaluate(box);
      ASSERT_LE(interval.lo, interval.hi) << formula;
      const Points points = random_points(box, 40, random.bits());
      const std::vector<float> values = values_at(*made, points);
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::isnan(values[i])) continue;
        EXPECT_GE(values[i], interval.lo) << formula;
        EXPECT_LE(values[i], interval.hi) << formula;
        const double exact = value_at(*made, points.at(i));
        EXPECT_GE(exact, interval.lo) << formula;
        EXPECT_LE(exact, interval.hi) << formula;
      }
    }
  }
}

/// Formulas that leave the domain of a function: not a number must never pass for inside.
TEST_P(TapeForms, IntervalsAllowForUndefinedValues) {
  Random random(19);
  for (const char* formula :
       {"sqrt(x)-3",  "log(y)-9",      "asin(2x)-4",          "acos(x+y)-9",       "x^0.3-5",    "1/x",
        "x/(y*z)",    "tan(3x)",       "max(sqrt(x)-3, y-9)", "min(sqrt(x), y)",   "mod(x,y)",   "x^y",
        "atan2(y,x)", "sign(sqrt(x))", "floor(1/x)",          "exp(40x)-exp(41y)", "x*exp(99y)", "log(abs(x))*0",
        "-sqrt(-1)",  "(x-9)/0"}) {
    const auto made = field(formula);
    for (int round = 0; round < 30; ++round) {
      const Box box = random_box(wide_cube, random);
      const Interval interval = made->evaluate(box);
      const Points points = random_points(box, 50, random.bits());
      const std::vector<float> values = values_at(*made, points);
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::isnan(values[i]))
          EXPECT_GE(interval.hi, 0) << formula;
        else
          EXPECT_TRUE(values[i] >= interval.lo && values[i] <= interval.hi) << formula << " " << values[i];
      }
    }
  }
}

}  // namespace evenmesh::testing
