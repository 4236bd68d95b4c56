#pragma once
/// Samples of fields in whatever form, against what is known of their solids.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "evenmesh/error.h"
#include "grid/sample_checks.h"
#include "shape/forms.h"

namespace evenmesh::testing {

class SampleForms : public FormTest {
 protected:
  Shape solid(const char* formula, const Box& bounds) const {
    return GetParam()(shape_from_expression(formula, {}, bounds));
  }
  static constexpr double pi = std::numbers::pi;
};

TEST_P(SampleForms, BallIsExact) {
  const SampleSet set = sampled(solid("x^2+y^2+z^2-1", {{-1.1, -1.1, -1.1}, {1.1, 1.1, 1.1}}), 90);
  expect_well_formed(set);
  const std::vector<bool> inside = expect_one_sign_grid(set);
  EXPECT_NEAR(volume_of(set, inside), 4 * pi / 3, 0.01 * 4 * pi / 3);
  EXPECT_NEAR(set.total_area, 4 * pi, 0.01 * 4 * pi);
  EXPECT_FALSE(set.cut_by_bounds);
  EXPECT_TRUE(set.source.empty());
  for (const SampleBlock& b : set.blocks)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      const Vec3 p = position(set, b, i);
      EXPECT_NEAR(norm(p), 1, 2 * GetParam().roots * set.grid.spacing);
      EXPECT_GT(dot(unpack_normal(set.normal[i]), normalized(p)), 1 - 1e-5);
    }
}

TEST_P(SampleForms, TorusAndItsThreads) {
  const Shape shape = solid("(sqrt(x^2+y^2)-1)^2+z^2-0.1225", {{-1.4, -1.4, -0.4}, {1.4, 1.4, 0.4}});
  const SampleSet set = sampled(shape, 100, 1);
  expect_well_formed(set);
  const std::vector<bool> inside = expect_one_sign_grid(set);
  EXPECT_NEAR(set.total_area, 4 * pi * pi * 0.35, 0.01 * 4 * pi * pi * 0.35);
  EXPECT_NEAR(volume_of(set, inside), 2 * pi * pi * 0.35 * 0.35, 0.05);
  expect_same(set, sampled(shape, 100, 2));
}

// Values that say little about the root: kinks, jumps, infinities, steep and flat sides.
TEST_P(SampleForms, RootsOfAwkwardFunctions) {
  for (const char* formula : {
           "exp(40(r-1)) - 1",                                // steep
           "min(r-1, 1000(r-1))",                             // a kink
           "500.0005sign(x^2+y^2+z^2-1) - 499.9995",          // a jump from -1000 to 0.001
           "(x^2+y^2+z^2-1) / max(0, -sign(x^2+y^2+z^2-1))",  // infinite outside
           "-sqrt(1-x^2-y^2-z^2)",                            // no number outside
       }) {
    SCOPED_TRACE(formula);
    const SampleSet set = sampled(solid(formula, {{-1.1, -1.2, -1.3}, {1.1, 1.2, 1.3}}), 40);
    expect_one_sign_grid(set);
    const double allowed = std::max(1e-3, GetParam().roots);
    double worst = 0;
    for (const SampleBlock& b : set.blocks)
      for (std::size_t i = b.begin; i < b.end; ++i) worst = std::max(worst, std::abs(norm(position(set, b, i)) - 1));
    EXPECT_LT(worst, allowed * set.grid.spacing);
  }
}

TEST_P(SampleForms, BoundsCapTheSolid) {
  const SampleSet set = sampled(solid("x^2+y^2-0.25", {{-1, -1, -0.7}, {1, 1, 0.8}}), 80);
  expect_well_formed(set);
  const std::vector<bool> inside = expect_one_sign_grid(set);
  EXPECT_TRUE(set.cut_by_bounds);
  EXPECT_NEAR(volume_of(set, inside), pi * 0.25 * 1.5, 0.04 * pi * 0.25 * 1.5);
  EXPECT_NEAR(set.total_area, 2 * pi * 0.5 * 1.5 + 2 * pi * 0.25, 0.01 * 2 * pi);
  for (const SampleBlock& b : set.blocks)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      const Vec3 p = position(set, b, i);
      EXPECT_LT(p.z, 0.8 + 1e-5);
      EXPECT_GT(p.z, -0.7 - 1e-5);
    }
}

TEST_P(SampleForms, FullBoundsAreABox) {
  const SampleSet set = sampled(solid("-1", {{0, 0, 0}, {1, 0.5, 0.25}}), 50);
  expect_well_formed(set);
  expect_one_sign_grid(set);
  EXPECT_TRUE(set.cut_by_bounds);
  EXPECT_NEAR(set.total_area, 2 * (0.5 + 0.25 + 0.125), 0.05);
}

TEST_P(SampleForms, FittedBoundsAreNoCut) {
  const char* const box = "max(abs(x)-1, abs(y)-0.7, abs(z)-0.5)";
  const SampleSet set = sampled(solid(box, {{-1, -0.7, -0.5}, {1, 0.7, 0.5}}), 60);
  expect_well_formed(set);
  expect_one_sign_grid(set);
  EXPECT_FALSE(set.cut_by_bounds);
  EXPECT_NEAR(set.total_area, 4 * 2 * (0.7 + 0.5 + 0.35), 0.4);
}

TEST_P(SampleForms, NothingInsideIsSaid) {
  for (const char* formula : {"1", "0/0"}) {
    const Shape nothing = solid(formula, {{0, 0, 0}, {1, 1, 1}});
    EXPECT_THROW(sampled(nothing, 20), UnusableInput) << formula;
  }
}

/// A shape of the gallery in a form.
using FormOfShape = std::tuple<Form, std::string>;

class GallerySamples : public ::testing::TestWithParam<FormOfShape> {};

TEST_P(GallerySamples, OneSignGridBoundsThem) {
  const auto& [form, name] = GetParam();
  const Shape shape = gallery_shape(name);
  const SampleSet set = sampled(form(shape), 64);
  expect_one_sign_grid(set);
  EXPECT_GT(set.size(), 100u);
  EXPECT_GT(set.total_area, 0);
  // Where f is flat, as at the dent of the heart, roundings decide.
  const bool rough = form.roots > on_cpu.roots;
  if (form.of != on_cpu.of) expect_near(set, sampled(shape, 64), rough ? form.roots : 1e-3, rough ? 1e-3 : 0);
}

/// The gallery's shapes that have a form.
inline auto gallery_in(const Form& form) {
  std::vector<std::string> names;
  for (const GalleryEntry& entry : gallery())
    if (form.has(gallery_shape(entry.name))) names.emplace_back(entry.name);
  return ::testing::Combine(::testing::Values(form), ::testing::ValuesIn(names));
}

inline std::string name_of_gallery_form(const ::testing::TestParamInfo<FormOfShape>& info) {
  std::string name = std::get<0>(info.param).name + ("_" + std::get<1>(info.param));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace evenmesh::testing
