/// Expressions on OpenGL have the values and gradients that they have on the CPU; see also forms_test.cpp.

#include <algorithm>
#include <cmath>

#include "evenmesh/glsl.h"
#include "evenmesh/solid.h"
#include "gl/context.h"
#include "gl/tape_field.h"
#include "gl/tape_glsl.h"
#include "grid/sample_checks.h"
#include "shape/expression.h"
#include "shape/expression_field.h"
#include "shape/fields.h"

namespace evenmesh {
namespace {

using testing::Gradients;
using testing::gradients_at;
using testing::Points;
using testing::random_points;
using testing::values_at;

/// Every operation of the tape, within its domain and out of it.
const char* const expressions[] = {
    "x",
    "3",
    "2x + 1",
    "3x - 2y",
    "x + y*z",
    "x - y",
    "x*y*z",
    "x/y",
    "x/(y*z)",
    "x^2 + y^3 - z^7",
    "x^-2",
    "x^0.5",
    "x^2.5",
    "x^y",
    "(1 + abs(x))^(y*z)",
    "(x - 3)^y",
    "x^1.7",
    "sqrt(x)",
    "sqrt(x^2 + y^2 + z^2) - 1",
    "r",
    "sin(3x)",
    "cos(50y)",
    "sin(1e5*x)",
    "tan(x + y)",
    "asin(x)",
    "acos(x*y)",
    "atan(5z)",
    "atan2(y, x)",
    "atan2(x, -1)",
    "exp(3x)",
    "exp(100x)",
    "exp(-x^2)",
    "log(x)",
    "log(x^2 + 0.1)",
    "abs(x) - abs(y)",
    "min(x, y, z)",
    "max(x, y, z)",
    "max(sqrt(x), y)",
    "min(log(y), x)",
    "floor(3x)",
    "mod(x, 0.7)",
    "mod(x, y)",
    "sign(x - y)",
    "sign(sqrt(x))",
    "0.1x + 1.1e-7y - 1e7*z",
    "1/x - 1/x",
    "2x^2(3-4x^2)^2+2y^2(3-4y^2)^2+2z^2(3-4z^2)^2 - 3",
};

std::vector<Shape> expression_shapes() {
  std::vector<Shape> shapes;
  for (const char* text : expressions) shapes.push_back(shape_from_expression(text, {}, {{-2, -2, -2}, {2, 2, 2}}));
  for (const GalleryEntry& entry : gallery()) {
    Shape shape = gallery_shape(entry.name);
    if (graph_of(*shape.field())) shapes.push_back(std::move(shape));
  }
  return shapes;
}

/// A typical size of values: their median.
double scale_of(std::vector<float> values) {
  std::erase_if(values, [](float v) { return !std::isfinite(v); });
  if (values.empty()) return 1;
  for (float& v : values) v = std::abs(v);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return std::max(1e-30, double{values[values.size() / 2]});
}

/// Numbers that are not as near as floats can be expected to come; not-a-numbers have to be where they were.
std::size_t differing(const std::vector<float>& a, const std::vector<float>& b, double scale) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i]))) continue;
    count += !(std::abs(a[i] - b[i]) <= std::max(1e-4 * std::abs(a[i]), 1e-5 * scale));
  }
  return count;
}

TEST(TapeOnGl, ValuesAndGradientsAreThoseOfTheCpu) {
  std::size_t same = 0, all = 0;
  for (const Shape& shape : expression_shapes()) {
    SCOPED_TRACE(shape.name);
    const Shape moved = on_gl(shape);
    ASSERT_TRUE(runs_on_gl(moved));
    const Points points = random_points(shape.bounds, 4000, 3);
    const std::vector<float> cpu = values_at(*shape.field(), points), gl = values_at(*moved.field(), points);
    // At jumps, a rounding may decide; there are few of them.
    EXPECT_LE(differing(cpu, gl, scale_of(cpu)), 4u);
    for (std::size_t i = 0; i < cpu.size(); ++i) same += cpu[i] == gl[i] || (std::isnan(cpu[i]) && std::isnan(gl[i]));
    all += cpu.size();
    const Gradients g = gradients_at(*shape.field(), points), h = gradients_at(*moved.field(), points);
    EXPECT_EQ(differing(gl, h.values, 0), 0u);
    EXPECT_LE(differing(g.dx, h.dx, scale_of(g.dx)), 4u);
    EXPECT_LE(differing(g.dy, h.dy, scale_of(g.dy)), 4u);
    EXPECT_LE(differing(g.dz, h.dz, scale_of(g.dz)), 4u);
  }
  RecordProperty("same_bits", std::to_string(double(same) / double(all)));
}

TEST(TapeOnGl, EnclosuresAndSinglePointsAreTheCpus) {
  Random random(5);
  for (const Shape& shape : expression_shapes()) {
    const auto moved = gl::make_tape_field(gl::shared_context(""), *graph_of(*shape.field()));
    EXPECT_TRUE(moved->encloses_surely() && moved->differentiates() && moved->has_gradient());
    for (int round = 0; round < 4; ++round) {
      const Box box = testing::random_box(shape.bounds, random);
      const Interval a = shape.field()->evaluate(box), b = moved->evaluate(box);
      EXPECT_TRUE(a.lo == b.lo && a.hi == b.hi) << shape.name;
      for (const float f : values_at(*moved, random_points(box, 50, random.bits())))
        EXPECT_TRUE(std::isnan(f) || (f >= b.lo && f <= b.hi)) << shape.name;
      Vec3 g, h;
      const double f = shape.field()->evaluate(box.center(), &g);
      const double again = moved->evaluate(box.center(), &h);
      EXPECT_TRUE(f == again || (std::isnan(f) && std::isnan(again))) << shape.name;
    }
  }
}

void expect_same_surface(const Shape& shape, const Shape& moved, std::size_t resolution) {
  SCOPED_TRACE(shape.name);
  ASSERT_TRUE(runs_on_gl(moved));
  ExecutionContext context(2);
  const Grid grid = make_grid(shape.bounds, resolution);
  const SampleSet on_cpu = sample_shape(shape, grid, context), on_device = sample_shape(moved, grid, context);
  expect_well_formed(on_device);
  expect_one_sign_grid(on_device);
  expect_near(on_cpu, on_device);
}

TEST(TapeOnGl, WithinTransformsAndCompounds) {
  const Affine turn = Affine::rotate({1, 2, 3}, 40);
  const Shape capped = shape_from_expression("x^2 + y^2 - 0.25", {}, {{-1, -1, -0.5}, {1, 1, 0.5}});
  for (const Shape& shape : {transformed(gallery_shape("torus"), turn), transformed(capped, turn)})
    expect_same_surface(shape, on_gl(shape), 40);
  const Shape whole = subtract(gallery_shape("cube"), {transformed(capped, turn), gallery_shape("sphere")});
  const Shape moved = on_gl(whole);
  EXPECT_EQ(moved.bounds, whole.bounds);
  expect_same_surface(whole, moved, 40);
}

TEST(TapeOnGl, LeavesTheRestWhereItIs) {
  for (const Shape& shape : {shape_from_box({{0, 0, 0}, {1, 1, 1}}), gallery_shape("julia"),
                             unite({shape_from_box({{0, 0, 0}, {1, 1, 1}}), gallery_shape("mandelbulb-8")})}) {
    const Shape moved = on_gl(shape);
    EXPECT_TRUE(moved.what == shape.what) << shape.name;
    EXPECT_FALSE(runs_on_gl(moved)) << shape.name;
  }
  EXPECT_TRUE(runs_on_gl(unite({shape_from_box({{0, 0, 0}, {1, 1, 1}}), on_gl(gallery_shape("sphere"))})));
}

TEST(TapeOnGl, IsText) {
  const Tape tape = compile_tape(parse_expression("x^2 + 0.1"));
  const std::string text = gl::glsl_of_tape(tape);
  EXPECT_EQ(text.find("float map(vec3 p) {"), 0u) << text;
  EXPECT_NE(text.find("uintBitsToFloat(0x3dcccccdu)"), std::string::npos) << "0.1 to the last bit: " << text;
}

}  // namespace
}  // namespace evenmesh
