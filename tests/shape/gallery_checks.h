#pragma once
/// Properties of the gallery's solids, and of bounds, in whatever form their functions are evaluated.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "shape/bounds.h"
#include "shape/fields.h"
#include "shape/forms.h"

namespace evenmesh::testing {

/// Solids of planes: away from their edges, gradients are units along an axis.
inline const std::vector<std::string> sharp_solids{"cube", "thin-plate", "menger-2", "menger-3"};

inline bool is_fractal(const Shape& shape) {
  for (const GalleryEntry& entry : gallery())
    if (entry.name == shape.name) return entry.fractal;
  return false;
}

class GalleryForms : public FormTest {
 protected:
  Shape made(const std::string& name) const { return GetParam()(gallery_shape(name)); }
  /// Those of the gallery that have this form.
  std::vector<Shape> shapes() const {
    std::vector<Shape> all;
    for (const GalleryEntry& entry : gallery()) {
      const Shape shape = gallery_shape(entry.name);
      if (GetParam().has(shape)) all.push_back(GetParam()(shape));
    }
    return all;
  }
};

/// Forms that differentiate, and enclose values in intervals.
class GalleryTapes : public GalleryForms {};

/// Every solid lies within its box: the outer layer of a grid around it is outside.
TEST_P(GalleryForms, SolidsLieWithinTheirBounds) {
  for (const Shape& shape : shapes()) {
    const auto field = field_of(shape);
    bool found = false;
    const Points all = random_points(shape.bounds, 20'000, 1);
    for (const float value : values_at(*field, all)) found = found || value < 0;
    EXPECT_TRUE(found) << shape.name << " has an inside";
    for (int side = 0; side < 6; ++side) {
      Box face = shape.bounds;
      (side % 2 == 0 ? face.lo : face.hi)[side / 2] = (side % 2 == 0 ? face.hi : face.lo)[side / 2];
      for (const float value : values_at(*field, random_points(face, 2000, 2)))
        EXPECT_GE(value, 0) << shape.name << " reaches side " << side;
    }
  }
}

TEST_P(GalleryTapes, FoundBoundsHoldTheSolid) {
  for (const Shape& shape : shapes()) {
    const auto field = field_of(shape);
    const Box box = find_bounds(*field);
    EXPECT_LT(box.longest_side(), 1.2 * shape.bounds.longest_side()) << shape.name;
    const Points points = random_points(shape.bounds, 20'000, 3);
    const std::vector<float> values = values_at(*field, points);
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_TRUE(values[i] >= 0 || box.contains(points.at(i))) << shape.name;
  }
}

TEST_P(GalleryTapes, IntervalsEnclose) {
  Random random(5);
  for (const Shape& shape : shapes()) {
    const auto field = field_of(shape);
    int decided = 0;
    for (int round = 0; round < 60; ++round) {
      const Box box = random_box(shape.bounds, random);
      const Interval interval = field->evaluate(box);
      decided += interval.lo >= 0 || interval.hi < 0 ? 1 : 0;
      const std::vector<float> values = values_at(*field, random_points(box, 60, random.bits()));
      for (const float value : values) {
        EXPECT_GE(value, interval.lo) << shape.name;
        EXPECT_LE(value, interval.hi) << shape.name;
      }
    }
    EXPECT_GT(decided, 0) << shape.name << ": intervals never prune";
  }
}

/// At points near the surface (where it matters) the gradient predicts the value a small step away.
TEST_P(GalleryForms, GradientsMatchDifferences) {
  for (const Shape& shape : shapes()) {
    if (is_fractal(shape)) continue;
    // Differences that are taken across an edge have no face's normal.
    const bool sharp = std::count(sharp_solids.begin(), sharp_solids.end(), shape.name) > 0;
    if (sharp && !shape.field()->differentiates()) continue;
    const auto doubles = field_of(gallery_shape(shape.name));
    const Points points = random_points(shape.bounds, 2000, 7);
    const Gradients gradients = gradients_at(*shape.field(), points);
    int compared = 0, apart = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vec3 difference;
      const double step = 1e-6;
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 above = points.at(i), below = above;
        above[axis] += step, below[axis] -= step;
        difference[axis] = (value_at(*doubles, above) - value_at(*doubles, below)) / (2 * step);
      }
      ++compared;
      apart += norm(gradients.at(i) - difference) <= 1e-3 * (1 + norm(difference)) ? 0 : 1;
    }
    EXPECT_LE(apart, compared / 100) << shape.name;
  }
}

TEST_P(GalleryTapes, SharpSolidsHaveFaceNormals) {
  for (const std::string& name : sharp_solids) {
    const Shape shape = made(name);
    const Points points = random_points(shape.bounds, 1000, 9);
    const Gradients gradients = gradients_at(*shape.field(), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 g = gradients.at(i);
      EXPECT_NEAR(std::abs(g.x) + std::abs(g.y) + std::abs(g.z), 1, 1e-5) << name;
      EXPECT_NEAR(norm(g), 1, 1e-5) << name;
    }
  }
}

/// The sponge by its digits: a point is out when two of its ternary digits of one place are 1.
inline bool in_sponge(Vec3 p, int level) {
  for (int a = 0; a < 3; ++a)
    if (p[a] < 0 || p[a] > 1) return false;
  for (int l = 0; l < level; ++l) {
    int middle = 0;
    for (int a = 0; a < 3; ++a) {
      const double digit = std::floor(3 * p[a]);
      middle += digit == 1 ? 1 : 0;
      p[a] = 3 * p[a] - digit;
    }
    if (middle >= 2) return false;
  }
  return true;
}

TEST_P(GalleryForms, SpongesAreSponges) {
  for (const int level : {2, 3}) {
    const Shape shape = made("menger-" + std::to_string(level));
    const Points points = random_points(shape.bounds, 20'000, 11);
    const std::vector<float> values = values_at(*shape.field(), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::abs(values[i]) < 1e-6) continue;
      EXPECT_EQ(values[i] < 0, in_sponge(points.at(i), level));
    }
  }
}

TEST_P(GalleryTapes, FindsSolidsWhereverTheyAre) {
  const auto check = [&](const char* formula, const Box& expected) {
    const Box box = find_bounds(*GetParam().field(formula));
    for (int axis = 0; axis < 3; ++axis) {
      const double side = expected.hi[axis] - expected.lo[axis];
      EXPECT_NEAR(box.lo[axis], expected.lo[axis], 0.15 * side) << formula;
      EXPECT_NEAR(box.hi[axis], expected.hi[axis], 0.15 * side) << formula;
      EXPECT_LE(box.lo[axis], expected.lo[axis]) << formula;
      EXPECT_GE(box.hi[axis], expected.hi[axis]) << formula;
    }
  };
  check("r - 1", {{-1, -1, -1}, {1, 1, 1}});
  check("x^2+y^2+z^2 = 1e-6", {{-1e-3, -1e-3, -1e-3}, {1e-3, 1e-3, 1e-3}});
  check("(x-1000)^2+y^2+z^2-1", {{999, -1, -1}, {1001, 1, 1}});
  check("x^2/10000+y^2+z^2-1", {{-100, -1, -1}, {100, 1, 1}});
  check("0.5 - exp(-x^2-y^2-z^2)", {{-0.8325, -0.8325, -0.8325}, {0.8325, 0.8325, 0.8325}});
}

}  // namespace evenmesh::testing
