/// Fields of GLSL agree with the same formulas on the CPU, wherever a point stands.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <thread>

#include "evenmesh/mesh_shape.h"
#include "gl/shaders.h"
#include "shape/field.h"
#include "shape/non_finite.h"

namespace evenmesh {
namespace {

using namespace testing;

struct Formula {
  const char *glsl, *expression;
};

const Formula formulas[] = {
    {"dot(p, p) - 1.0", "x^2 + y^2 + z^2 - 1"},
    {"pow(p.x*p.x + p.y*p.y + p.z*p.z + 0.84, 2.0) - 4.0*(p.x*p.x + p.y*p.y)", "(x^2+y^2+z^2+0.84)^2 - 4(x^2+y^2)"},
    {"sin(3.0*p.x) + cos(3.0*p.y)*sin(2.0*p.z)", "sin(3x) + cos(3y)*sin(2z)"},
    {"max(abs(p.x), max(abs(p.y), abs(p.z))) - 0.8", "max(abs(x), max(abs(y), abs(z))) - 0.8"},
    {"exp(-dot(p, p)) - 0.3", "exp(-(x^2+y^2+z^2)) - 0.3"},
};

TEST(GlslField, AgreesWithExpressions) {
  const Points points = scattered(5000);
  std::vector<float> f(points.size()), g(points.size());
  for (const Formula& formula : formulas) {
    const Shape shape = shader(std::string("float map(vec3 p) { return ") + formula.glsl + "; }");
    shape.field()->evaluate(points.batch(), f);
    shape_from_expression(formula.expression).field()->evaluate(points.batch(), g);
    for (std::size_t i = 0; i < f.size(); ++i) {
      ASSERT_NEAR(f[i], g[i], 3e-5 * (1 + std::abs(g[i]))) << formula.glsl << " at " << i;
    }
  }
}

/// Angle between vectors, radians.
double angle(const Vec3& a, const Vec3& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

double worst_angle(const std::string& text, const Points& points, Vec3 (*exact)(const Vec3&)) {
  const Shape shape = shader(text);
  const std::size_t n = points.size();
  std::vector<float> f(n), dx(n), dy(n), dz(n);
  shape.field()->evaluate_gradient(points.batch(), f, dx, dy, dz);
  double worst = 0;
  for (std::size_t i = 0; i < n; ++i)
    worst = std::max(worst, angle({dx[i], dy[i], dz[i]}, exact({points.x[i], points.y[i], points.z[i]})));
  return worst;
}

TEST(GlslField, HasGradientsThatGiveNormals) {
  Points on_sphere = scattered(20000), on_torus = on_sphere;
  for (std::size_t i = 0; i < on_sphere.size(); ++i) {
    const Vec3 p = normalized({on_sphere.x[i], on_sphere.y[i], on_sphere.z[i]});
    on_sphere.x[i] = float(p.x), on_sphere.y[i] = float(p.y), on_sphere.z[i] = float(p.z);
    const double a = 2 * on_torus.x[i], b = 2 * on_torus.y[i], r = 1 + 0.3 * std::cos(b);
    on_torus.x[i] = float(r * std::cos(a)), on_torus.y[i] = float(r * std::sin(a)),
    on_torus.z[i] = float(0.3 * std::sin(b));
  }
  const double at_sphere = worst_angle(sphere, on_sphere, [](const Vec3& p) { return p; });
  const double at_torus = worst_angle("float map(vec3 p) { return length(vec2(length(p.xy) - 1.0, p.z)) - 0.3; }",
                                      on_torus, [](const Vec3& p) {
                                        const double r = std::hypot(p.x, p.y);
                                        return Vec3{p.x * (1 - 1 / r), p.y * (1 - 1 / r), p.z};
                                      });
  RecordProperty("sphere", std::to_string(at_sphere));
  RecordProperty("torus", std::to_string(at_torus));
  EXPECT_LT(at_sphere, 1e-3);
  EXPECT_LT(at_torus, 1e-3);
}

TEST(GlslField, GivesTheSameBitsWhereverAPointStands) {
  const Shape shape = shader("float map(vec3 p) { return sin(p.x*7.0)*cos(p.y*5.0) + pow(length(p), 1.7) - 1.0; }");
  const Points points = scattered(10007);
  const std::size_t n = points.size();
  std::vector<float> all(n), pieces(n), with_gradient(n), dx(n), dy(n), dz(n);
  shape.field()->evaluate(points.batch(), all);
  for (std::size_t begin = 0, size = 1; begin < n; begin += size, size = size * 2 + 1) {
    size = std::min(size, n - begin);
    const PointBatch batch = points.batch();
    shape.field()->evaluate(
        PointBatch{batch.x.subspan(begin, size), batch.y.subspan(begin, size), batch.z.subspan(begin, size)},
        std::span<float>(pieces).subspan(begin, size));
  }
  shape.field()->evaluate_gradient(points.batch(), with_gradient, dx, dy, dz);
  EXPECT_EQ(0, std::memcmp(all.data(), pieces.data(), n * sizeof(float)));
  EXPECT_EQ(0, std::memcmp(all.data(), with_gradient.data(), n * sizeof(float)));
  for (const std::size_t i : {std::size_t{0}, std::size_t{77}, n - 1}) {
    Vec3 gradient;
    const double f = shape.field()->evaluate({points.x[i], points.y[i], points.z[i]}, &gradient);
    EXPECT_EQ(f, all[i]);
    EXPECT_EQ(gradient, (Vec3{dx[i], dy[i], dz[i]}));
  }
}

TEST(GlslField, TakesBatchesOfAnySize) {
  const Shape shape = shader(sphere);
  std::vector<float> nothing;
  shape.field()->evaluate(PointBatch{}, nothing);
  const Points points = scattered(1'500'001);
  std::vector<float> f(points.size());
  shape.field()->evaluate(points.batch(), f);
  for (std::size_t i = 0; i < f.size(); i += 1000)
    ASSERT_NEAR(f[i], norm({points.x[i], points.y[i], points.z[i]}) - 1, 1e-6);
  EXPECT_GE(shape.field()->batch_size(), 100'000u);
}

TEST(GlslField, CountsWhatIsNotFinite) {
  const Shape shape = shader(
      "float map(vec3 p) { return p.x > 1.0 ? log(-1.0) : p.x < -1.0 ? 1.0 / (p.y * 0.0) : "
      "p.z > 1.0 ? -1.0 / abs(p.y * 0.0) : length(p) - 0.5; }");
  const auto& field = dynamic_cast<const gl::GlslField&>(*shape.field());
  const std::size_t before = field.non_finite();
  const std::vector<float> x{2, -2, -2, 0, 0}, y{1, 1, -1, 1, 0}, z{0, 0, 0, 2, 0};
  std::vector<float> f(5);
  field.evaluate(PointBatch{x, y, z}, f);
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(f[i] < 0) << "is inside: " << i;
  EXPECT_LT(f[4], 0);
  EXPECT_EQ(field.non_finite(), before + 4);
}

TEST(GlslField, WhatIsNotFiniteIsCountedOnceForEachRun) {
  const Shape shape = shader("float map(vec3 p) { return p.x > 0.3 ? sqrt(-1.0 - p.y * p.y) : length(p) - 0.5; }");
  const MeshOptions options{.vertices = 200, .bounds = Box{{-1, -1, -1}, {1, 1, 1}}};
  std::vector<std::size_t> counts;
  for (int run = 0; run < 2; ++run) {
    const NonFiniteValues values(shape);
    mesh_shape(shape, options);
    counts.push_back(values.count());
  }
  EXPECT_GT(counts[0], 0u);
  EXPECT_EQ(counts[0], counts[1]);
}

TEST(GlslField, EnclosesBoxesWhereALipschitzConstantIsGiven) {
  const Shape unknown = shader(sphere);
  const Box box{{0.5, 0.5, 0.5}, {0.75, 0.75, 0.625}};
  EXPECT_EQ(unknown.field()->evaluate(box).hi, std::numeric_limits<double>::infinity());
  const Shape known = shape_from_glsl(sphere, {.lipschitz = 1.0});
  const Interval range = known.field()->evaluate(box);
  EXPECT_LE(range.lo, norm(box.lo) - 1);
  EXPECT_GE(range.hi, norm(box.hi) - 1);
  EXPECT_LT(range.hi - range.lo, 1.001 * box.diagonal());
  std::vector<Box> boxes{box, {{2, 2, 2}, {3, 3, 3}}, {{0, 0, 0}, {0.1, 0.1, 0.1}}};
  std::vector<Interval> ranges(3);
  known.field()->enclose(boxes, ranges);
  EXPECT_EQ(ranges[0].lo, range.lo);
  EXPECT_GT(ranges[1].lo, 0);
  EXPECT_LT(ranges[2].hi, 0);
  EXPECT_THROW(shape_from_glsl(sphere, {.lipschitz = 0.0}), InvalidInput);
}

TEST(GlslField, MayBeUsedFromSeveralThreads) {
  const Shape one = shader(sphere), two = shader("float map(vec3 p) { return p.x + 2.0*p.y; }");
  const Points points = scattered(3000);
  std::vector<float> expected_one(points.size()), expected_two(points.size());
  one.field()->evaluate(points.batch(), expected_one);
  two.field()->evaluate(points.batch(), expected_two);
  std::vector<std::thread> threads;
  std::vector<int> bad(8, 0);
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&, t] {
      std::vector<float> f(points.size());
      for (int round = 0; round < 20; ++round) {
        (t % 2 ? one : two).field()->evaluate(points.batch(), f);
        bad[t] += f != (t % 2 ? expected_one : expected_two);
        if (round == 10) bad[t] += value_at(sphere, {2, 0, 0}) != 1.0f;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(bad, std::vector<int>(8, 0));
}

}  // namespace
}  // namespace evenmesh
