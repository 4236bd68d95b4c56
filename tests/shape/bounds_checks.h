#pragma once
/// Bounds of fields that are asked at points, wherever these are evaluated.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "evenmesh/error.h"
#include "evenmesh/solid.h"
#include "shape/bounds.h"
#include "shape/fields.h"
#include "shape/forms.h"
#include "shape/remote_field.h"

namespace evenmesh::testing {

inline void expect_close(const Box& box, const Box& expected, double share, const std::string& what) {
  for (int a = 0; a < 3; ++a) {
    const double side = expected.hi[a] - expected.lo[a];
    EXPECT_NEAR(box.lo[a], expected.lo[a], share * side) << what << " axis " << a;
    EXPECT_NEAR(box.hi[a], expected.hi[a], share * side) << what << " axis " << a;
  }
}

inline std::string message(const Field& field) {
  try {
    find_bounds(field);
  } catch (const UnusableInput& error) {
    return error.what();
  }
  return "";
}

class ProbedBounds : public FormTest {
 protected:
  /// A function on a device of this form, or as if on one.
  RemoteField remote(const std::string& text, double slope = 0) const {
    return RemoteField(GetParam().field(text, slope), slope);
  }
};

TEST_P(ProbedBounds, AgreeWithIntervals) {
  for (const std::string& formula : GetParam().some<std::string>(
           {"r-1", "r-0.003", "r-700", "(x-3)^2+(y+2)^2+z^2-1", "(sqrt(x^2+y^2)-1)^2+z^2-0.1", "x^4+y^4+z^4-1",
            "max(abs(x),abs(y)-2,abs(z)-0.1)-0.2", "abs(x)+abs(y)+abs(z)-1", "(x^2+9y^2/4+z^2-1)^3-x^2z^3-9y^2z^3/80",
            "x^2/10000+y^2+z^2-1", "0.5 - exp(-x^2-y^2-z^2)", "min((x-5)^2+y^2+z^2-1, (x+1)^2+y^2+z^2-0.01)",
            "max(abs(x)+abs(y)-1, abs(z)-3)"})) {
    const RemoteField far = remote(formula);
    expect_close(find_bounds(far), find_bounds(*parse(formula)), 0.05, formula);
    EXPECT_EQ(far.single_points, 0u);
    EXPECT_LE(far.calls, 200u) << formula;
    EXPECT_LE(far.asked, 40'000'000u) << formula;
  }
  // Where intervals are wide, points see more.
  const double side = std::sqrt(2.5 + std::sqrt(6.25 + 0.7));
  const Box tangle{{-side, -side, -side}, {side, side, side}};
  expect_close(find_bounds(remote("x^4-5x^2+y^4-5y^2+z^4-5z^2+11.8")), tangle, 0.02, "tangle");
}

TEST_P(ProbedBounds, NothingIsCutOff) {
  // A ball with a needle, 1/100 thick, and one with a small ball beside it.
  const Box needle = find_bounds(remote("min(r-1, max(sqrt(y^2+z^2)-0.01, abs(x)-3))"));
  EXPECT_TRUE(needle.contains({3, 0, 0}) && needle.contains({-3, 0, 0}));
  const Box beside = find_bounds(remote("min(r-1, sqrt((x-1.3)^2+y^2+z^2)-0.05)"));
  EXPECT_TRUE(beside.contains({1.35, 0, 0}));
  expect_close(beside, {{-1, -1, -1}, {1.35, 1, 1}}, 0.05, "beside");
}

TEST_P(ProbedBounds, SayWhyThereAreNone) {
  for (const std::string& formula : GetParam().some<std::string>(
           {"z", "cos(x)+cos(y)+cos(z)", "max(z, -r+1)", "min(z+2, r-1)", "x^2+y^2-1", "r-5000"})) {
    const std::string text = message(remote(formula));
    EXPECT_NE(text.find("--bounds"), std::string::npos) << formula;
    EXPECT_NE(text.find("beyond ±1024"), std::string::npos) << formula;
    EXPECT_EQ(text.find("flip"), std::string::npos) << formula;
  }
  EXPECT_NE(message(remote("1-r")).find("flip the sign"), std::string::npos);
  EXPECT_NE(message(remote("1+r")).find("nowhere"), std::string::npos);
  EXPECT_NE(message(remote("0/0*x")).find("not a finite number"), std::string::npos);
}

TEST_P(ProbedBounds, OfWhatIsNearWhenTheFarIsUnbounded) {
  const Box box = find_bounds(remote("min(r-1, 300-r)"));
  expect_close(box, {{-1, -1, -1}, {1, 1, 1}}, 0.05, "ball in a shell");
}

TEST_P(ProbedBounds, SlopesAreEnclosedInBatches) {
  for (const char* formula : {"r-1", "sqrt((sqrt(x^2+y^2)-1)^2+z^2)-0.3", "min(r-1, sqrt((x-9)^2+y^2+z^2)-0.5)"}) {
    const RemoteField far = remote(formula, 1.0001);
    expect_close(find_bounds(far), find_bounds(*parse(formula)), 0.05, formula);
    EXPECT_EQ(far.single_points, 0u);
    EXPECT_LE(far.calls, 400u) << formula;
  }
  EXPECT_NE(message(remote("z", 1.0001)).find("bounded"), std::string::npos);
}

TEST_P(ProbedBounds, OfPartsOfSolids) {
  const auto far = std::make_shared<const RemoteField>(GetParam().field("r-1"));
  const Shape ball{"ball", {}, far, false};
  expect_close(find_bounds(transformed(ball, Affine::translate({5, 0, 0}))), {{4, -1, -1}, {6, 1, 1}}, 0.05, "moved");
}

}  // namespace evenmesh::testing
