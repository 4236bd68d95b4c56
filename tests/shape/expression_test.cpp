#include "shape/expression.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "evenmesh/error.h"
#include "shape/fields.h"

namespace evenmesh {
namespace {

using testing::parse;
using testing::value_at;

constexpr Vec3 p{0.7, -1.3, 0.4};

double at_p(std::string_view text, const std::map<std::string, double>& parameters = {}) {
  return value_at(*parse(text, parameters), p);
}

std::string message_of(std::string_view text, const std::map<std::string, double>& parameters = {}) {
  try {
    parse_expression(text, parameters);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(Expression, FollowsTheUsualPrecedence) {
  EXPECT_DOUBLE_EQ(at_p("1 + 2*3 - 4/2"), 5);
  EXPECT_DOUBLE_EQ(at_p("2^3^2"), 512);
  EXPECT_DOUBLE_EQ(at_p("-2^2"), -4);
  EXPECT_DOUBLE_EQ(at_p("2^-1"), 0.5);
  EXPECT_DOUBLE_EQ(at_p("8/4/2"), 1);
  EXPECT_DOUBLE_EQ(at_p("8-4-2"), 2);
  EXPECT_DOUBLE_EQ(at_p("--3"), 3);
  EXPECT_DOUBLE_EQ(at_p("2**3"), 8);
  EXPECT_NEAR(at_p("x - y*z^2"), p.x - p.y * p.z * p.z, 1e-14);
}

TEST(Expression, MultipliesWhatStandsTogether) {
  EXPECT_NEAR(at_p("4x"), 4 * p.x, 1e-14);
  EXPECT_NEAR(at_p("2(x+1)"), 2 * (p.x + 1), 1e-14);
  EXPECT_NEAR(at_p("x y"), p.x * p.y, 1e-14);
  EXPECT_NEAR(at_p("16xz(x+y)"), 16 * p.x * p.z * (p.x + p.y), 1e-13);
  EXPECT_NEAR(at_p("x^2z^3"), p.x * p.x * p.z * p.z * p.z, 1e-14);
  EXPECT_NEAR(at_p("xz^3"), p.x * p.z * p.z * p.z, 1e-14);
  EXPECT_NEAR(at_p("(x+1)(y-1)"), (p.x + 1) * (p.y - 1), 1e-14);
  EXPECT_NEAR(at_p("2sin(3x)"), 2 * std::sin(3 * p.x), 1e-14);
  EXPECT_NEAR(at_p("3pi x"), 3 * std::numbers::pi * p.x, 1e-13);
  EXPECT_NEAR(at_p("9y^2/4"), 9 * p.y * p.y / 4, 1e-14);
  EXPECT_NEAR(at_p("1/2x"), p.x / 2, 1e-14);
}

TEST(Expression, KnowsFunctionsAndConstants) {
  EXPECT_NEAR(at_p("r"), norm(p), 1e-14);
  EXPECT_NEAR(at_p("r^2"), squared_norm(p), 1e-14);
  EXPECT_NEAR(at_p("pi + e"), std::numbers::pi + std::numbers::e, 1e-14);
  EXPECT_NEAR(at_p("sin(x)+cos(y)+tan(z)"), std::sin(p.x) + std::cos(p.y) + std::tan(p.z), 1e-14);
  EXPECT_NEAR(at_p("asin(x)+acos(z)+atan(y)"), std::asin(p.x) + std::acos(p.z) + std::atan(p.y), 1e-14);
  EXPECT_NEAR(at_p("atan2(y,x)"), std::atan2(p.y, p.x), 1e-14);
  EXPECT_NEAR(at_p("exp(x)-log(z)+sqrt(x)"), std::exp(p.x) - std::log(p.z) + std::sqrt(p.x), 1e-14);
  EXPECT_NEAR(at_p("abs(y) + floor(y) + sign(y)"), 1.3 - 2 - 1, 1e-14);
  EXPECT_NEAR(at_p("min(x,y,z) + max(x,y,z)"), p.y + p.x, 1e-14);
  EXPECT_NEAR(at_p("mod(y, 1)"), -1.3 + 2, 1e-14);
  EXPECT_NEAR(at_p("x^0.5 + x^2.5 + x^-2 + x^1.7"),
              std::sqrt(p.x) + std::pow(p.x, 2.5) + std::pow(p.x, -2) + std::pow(p.x, 1.7), 1e-13);
  for (int n = 1; n <= 16; ++n) EXPECT_NEAR(at_p("y^" + std::to_string(n)), std::pow(p.y, n), 1e-12) << n;
}

TEST(Expression, TakesParametersAndEquations) {
  EXPECT_NEAR(at_p("a x + R", {{"a", 3.0}, {"R", 2.0}}), 3 * p.x + 2, 1e-14);
  EXPECT_NEAR(at_p("r x", {{"r", 3.0}}), 3 * p.x, 1e-14) << "a parameter hides the radius";
  EXPECT_NEAR(at_p("x^2 = y - 1"), p.x * p.x - (p.y - 1), 1e-14);
  EXPECT_THROW(parse_expression("x", {{"sin", 1.0}}), InvalidInput);
  EXPECT_THROW(parse_expression("x", {{"y", 1.0}}), InvalidInput);
  EXPECT_THROW(parse_expression("x", {{"2a", 1.0}}), InvalidInput);
  EXPECT_THROW(parse_expression("x", {{"a", std::nan("")}}), InvalidInput);
}

TEST(Expression, ReadsTypographicSigns) {
  EXPECT_NEAR(at_p("x² − y³·2 × π"), p.x * p.x - p.y * p.y * p.y * 2 * std::numbers::pi, 1e-13);
  EXPECT_NEAR(at_p("x¹²"), std::pow(p.x, 12), 1e-14);
}

TEST(Expression, PointsAtTheMistake) {
  EXPECT_EQ(message_of("sin(x+y"), "column 8: expected ')'\n  sin(x+y\n         ^");
  EXPECT_EQ(message_of("x²+$"), "column 4: unexpected character\n  x²+$\n     ^");
  const std::string far = message_of(std::string(300, '(') + "?" + std::string(300, ')'));
  EXPECT_EQ(far.substr(0, 11), "column 301:");
  EXPECT_LT(far.size(), 250u) << "only the part around the column is shown";
}

TEST(Expression, SaysWhatIsWrong) {
  const auto mentions = [](std::string_view text, std::string_view part) {
    const std::string message = message_of(text);
    EXPECT_NE(message.find(part), std::string::npos) << text << " -> " << message;
  };
  mentions("", "empty");
  mentions("   ", "empty");
  mentions("x +", "ends where");
  mentions("x + * y", "expected a number");
  mentions("sinx", "functions need brackets: sin(x)");
  mentions("sin4x", "functions need brackets: sin(4x)");
  mentions("sqr(x)", "sqrt");
  mentions("cso(x)", "did you mean cos");
  mentions("a x", "unknown name 'a'");
  mentions("sin x", "expected '('");
  mentions("atan2(x)", "takes 2 arguments, not 1");
  mentions("sin(x, y)", "takes 1 argument, not 2");
  mentions("min(x)", "2 or more");
  mentions("x = y = z", "only one '='");
  mentions("x)", "no bracket is open");
  mentions("2 3", "expected an operator");
  mentions("1,5 x", "decimals take a point");
  mentions("1.2.3", "two decimal points");
  mentions("[x]", "round brackets");
  mentions("x < 1", "comparison");
  mentions("1e999", "out of range");
  mentions("\xff\xfe", "unexpected character");
}

TEST(Expression, GuardsLengthAndNesting) {
  EXPECT_NO_THROW(parse_expression(std::string(900, '(') + "x" + std::string(900, ')')));
  EXPECT_THROW(parse_expression(std::string(5000, '(') + "x" + std::string(5000, ')')), InvalidInput);
  EXPECT_THROW(parse_expression(std::string(90000, '-') + "x"), InvalidInput);
  EXPECT_THROW(parse_expression(std::string(100001, ' ') + "x"), InvalidInput);
  std::string tower = "x", names(99999, 'x'), sum = "x";
  while (tower.size() < 20000) tower += "^2";
  EXPECT_THROW(parse_expression(tower), InvalidInput);
  EXPECT_THROW(parse_expression(names), InvalidInput);
  while (sum.size() < 99000) sum += "+sin(x y)";
  EXPECT_NO_THROW(parse_expression(sum));
}

TEST(Expression, SharesAndFolds) {
  const auto size = [](std::string_view text) { return parse_expression(text).nodes.size(); };
  EXPECT_EQ(size("sin(x)+sin(x)"), size("2sin(x)"));
  EXPECT_EQ(size("(x+y)*(x+y)"), size("(y+x)^2"));
  EXPECT_EQ(size("2*3*x/6"), size("x+0"));
  EXPECT_EQ(size("x^2+y^2+z^2"), size("r^2"));
  EXPECT_LE(size("2x^2(3-4x^2)^2+2y^2(3-4y^2)^2+2z^2(3-4z^2)^2 = 3"), 18u);
  EXPECT_EQ(size("x-x+3"), size("3"));
}

/// Strings of fragments that occur in formulas: most are refused, none may do anything but throw InvalidInput.
TEST(Expression, SurvivesRandomStrings) {
  const std::vector<std::string> pieces{"x",    "y",     "z",    "r",    "(",      ")",  "+",  "-", "*",
                                        "/",    "^",     "²",    "1",    "2",      ".",  ",",  "=", "sin(",
                                        "max(", "min(",  "mod(", "abs(", "e",      "pi", "1e", " ", "a",
                                        "\xc3", "sqrt(", "exp(", "log(", "floor(", "\n", "³"};
  Random random(7);
  const testing::Points points = testing::random_points({{-2, -2, -2}, {2, 2, 2}}, 5, 1);
  int parsed = 0;
  for (int round = 0; round < 5000; ++round) {
    std::string text;
    for (std::uint64_t n = random.below(14); n-- > 0;) text += pieces[random.below(pieces.size())];
    // Closing what is open lets far more strings through.
    if (random.below(2) == 0)
      text += std::string(static_cast<std::size_t>(std::count(text.begin(), text.end(), '(')), ')');
    try {
      const auto field = parse(text);
      testing::gradients_at(*field, points);
      const Interval i = field->evaluate(Box{{-1, 0, 1}, {1, 0.5, 1}});
      EXPECT_LE(i.lo, i.hi) << text;
      ++parsed;
    } catch (const InvalidInput&) {
    }
  }
  EXPECT_GT(parsed, 100);
}

}  // namespace
}  // namespace evenmesh
