#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "evenmesh/error.h"
#include "shape/bounds.h"
#include "shape/fields.h"
#include "shape/gallery_checks.h"

namespace evenmesh {
namespace testing {

INSTANTIATE_TEST_SUITE_P(Gallery, GalleryForms, ::testing::Values(on_cpu), name_of_form);
INSTANTIATE_TEST_SUITE_P(Gallery, GalleryTapes, ::testing::Values(on_cpu), name_of_form);

}  // namespace testing
namespace {

using testing::parse;
using testing::Points;
using testing::random_points;
using testing::value_at;

TEST(Gallery, HasEveryShapeOnce) {
  std::set<std::string_view> names;
  for (const GalleryEntry& entry : gallery()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_FALSE(entry.formula.empty());
    EXPECT_EQ(gallery_shape(entry.name).name, entry.name);
  }
  for (const char* name :
       {"sphere", "torus",     "thin-torus",  "rounded-box", "cube",   "thin-plate",   "touching-balls",
        "trig",   "octic",     "octic-balls", "klein",       "tangle", "heart",        "barth",
        "gyroid", "schwarz-p", "menger-2",    "menger-3",    "julia",  "mandelbulb-7", "mandelbulb-8"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(Gallery, SuggestsNames) {
  const auto message = [](std::string_view name) -> std::string {
    try {
      gallery_shape(name);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("octik").find("did you mean octic?"), std::string::npos);
  EXPECT_NE(message("mandelbulb").find("mandelbulb-7 or mandelbulb-8"), std::string::npos);
  EXPECT_NE(message("quux").find("sphere, torus"), std::string::npos);
}

/// Fractals by their definition, in double precision.
bool in_julia(const Vec3& p) {
  double a = p.x, b = p.y, c = p.z, d = 0;
  for (int k = 0; k < 16; ++k) {
    const double n = a * a - b * b - c * c - d * d;
    b = 2 * a * b + 0.2, c = 2 * a * c + 0.3, d = 2 * a * d, a = n + 0.1;
    if (a * a + b * b + c * c + d * d > 1e8) return false;
  }
  return a * a + b * b + c * c + d * d < 4;
}

bool in_bulb(const Vec3& p, int degree) {
  Vec3 q = p;
  for (int k = 0; k < 12; ++k) {
    const double r = norm(q), theta = degree * std::atan2(std::hypot(q.x, q.y), q.z),
                 phi = degree * std::atan2(q.y, q.x);
    q = p +
        std::pow(r, degree) * Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    if (norm(q) > 50) return false;
  }
  return norm(q) < 2;
}

TEST(Gallery, FractalsFollowTheirDefinition) {
  const Points points = random_points({{-1.3, -1.3, -1.3}, {1.3, 1.3, 1.3}}, 4000, 13);
  const auto count_apart = [&](const char* name, const auto& contains) {
    const Shape shape = gallery_shape(name);
    const std::vector<float> values = testing::values_at(*shape.field(), points);
    int apart = 0, within = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      within += values[i] < 0 ? 1 : 0;
      apart += (values[i] < 0) != contains(points.at(i)) ? 1 : 0;
    }
    EXPECT_GT(within, 200) << name;
    EXPECT_LT(apart, 20) << name << ": only points very near the surface may differ";
  };
  count_apart("julia", in_julia);
  count_apart("mandelbulb-7", [](const Vec3& p) { return in_bulb(p, 7); });
  count_apart("mandelbulb-8", [](const Vec3& p) { return in_bulb(p, 8); });
}

/// Distance estimates change little from step to step and never jump through zero: root finding needs both.
TEST(Gallery, FractalsAreContinuousOutside) {
  for (const char* name : {"julia", "mandelbulb-8"}) {
    const Shape shape = gallery_shape(name);
    Points ray(2000);
    for (std::size_t i = 0; i < ray.size(); ++i) ray.x[i] = 1.1f + 1e-4f * static_cast<float>(i), ray.y[i] = 0.4f;
    const std::vector<float> values = testing::values_at(*shape.field(), ray);
    for (std::size_t i = 1; i < values.size(); ++i)
      EXPECT_LT(std::abs(values[i] - values[i - 1]), 2e-3 + 0.05 * std::abs(values[i])) << name << " " << i;
  }
}

TEST(Bounds, SaysWhyThereAreNone) {
  const auto message = [](const Field& field) -> std::string {
    try {
      find_bounds(field);
    } catch (const UnusableInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(*parse("z")).find("--bounds"), std::string::npos);
  EXPECT_EQ(message(*parse("z")).find("flip"), std::string::npos);
  EXPECT_NE(message(*parse("cos(x)+cos(y)+cos(z)")).find("bounded"), std::string::npos);
  EXPECT_NE(message(*parse("1-x^2-y^2-z^2")).find("flip the sign"), std::string::npos);
  EXPECT_NE(message(*parse("1+r")).find("nowhere"), std::string::npos);
  EXPECT_NE(message(*parse("(r^2-1)^2")).find("nowhere"), std::string::npos);
  EXPECT_NE(message(*parse("1/0")).find("nowhere"), std::string::npos);
  const Shape indicator = shape_from_indicator([](const Vec3&) { return true; }, {{0, 0, 0}, {1, 1, 1}});
  EXPECT_NE(message(*indicator.field()).find("--bounds"), std::string::npos);
}

TEST(Shape, ChecksMeshes) {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}}, {{0, 1, 2}}};
  const Shape shape = shape_from_mesh(mesh, "corner");
  EXPECT_EQ(shape.bounds, (Box{{0, 0, 0}, {1, 1, 0}})) << "unused vertices do not count";
  ASSERT_NE(shape.mesh(), nullptr);
  EXPECT_EQ(shape.field(), nullptr);
  EXPECT_THROW(shape_from_mesh(Mesh{}), UnusableInput);
  Mesh wrong = mesh;
  wrong.triangles[0][2] = 4;
  EXPECT_THROW(shape_from_mesh(wrong), InvalidInput);
  wrong = mesh;
  wrong.vertices[1].y = std::nan("");
  EXPECT_THROW(shape_from_mesh(wrong), InvalidInput);
}

TEST(Shape, ChecksPoints) {
  const PointCloud cloud{{{0, 0, 0}, {1, 2, 3}}, {{0, 0, 1}, {0, 0, 0}}};
  const Shape shape = shape_from_points(cloud, "two");
  EXPECT_EQ(shape.bounds, (Box{{0, 0, 0}, {1, 2, 3}}));
  ASSERT_NE(shape.points(), nullptr);
  EXPECT_EQ(shape.points()->normals, cloud.normals);
  EXPECT_EQ(shape.mesh(), nullptr);
  EXPECT_EQ(shape.field(), nullptr);
  EXPECT_EQ(shape_from_expression("r-1").points(), nullptr);
  EXPECT_THROW(shape_from_points({}), UnusableInput);
  EXPECT_THROW(shape_from_points({cloud.points, {{0, 0, 1}}}), InvalidInput);
  EXPECT_THROW(shape_from_points({{{0, std::nan(""), 0}}, {}}), InvalidInput);
  EXPECT_THROW(shape_from_points({{{0, 0, 0}}, {{0, std::nan(""), 0}}}), InvalidInput);
}

TEST(Shape, ChecksBounds) {
  EXPECT_TRUE(shape_from_expression("r-1").bounds.empty());
  EXPECT_TRUE(shape_from_expression("z", {}, {{-1, -1, -1}, {1, 1, 1}}).capped_by_bounds);
  EXPECT_THROW(shape_from_expression("z", {}, {{1, 1, 1}, {-1, -1, -1}}), InvalidInput);
  EXPECT_THROW(shape_from_indicator([](const Vec3&) { return true; }, {}), InvalidInput);
  EXPECT_THROW(shape_from_indicator({}, {{0, 0, 0}, {1, 1, 1}}), InvalidInput);
}

TEST(Shape, IndicatorsAreMinusOneAndOne) {
  const Shape shape = shape_from_indicator([](const Vec3& p) { return p.x < 0.5; }, {{0, 0, 0}, {1, 1, 1}});
  const Points points = random_points(shape.bounds, 100, 1);
  const std::vector<float> values = testing::values_at(*shape.field(), points);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(values[i], points.x[i] < 0.5 ? -1.0f : 1.0f);
  EXPECT_FALSE(shape.field()->has_gradient());
}

}  // namespace
}  // namespace evenmesh
