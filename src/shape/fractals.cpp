// Escape-time fractals as continuous fields.
//
// With |p_k| the distance of the k-th iterate of a map of degree n from the origin and dr_k a bound on its derivative,
// |p| log|p| / dr is invariant along an orbit far out (Hart, Sandin, Kauffman 1989; Milnor, Dynamics in one complex
// variable, §9). Subtracting log B / n^(N−k) from log|p_k| makes it vanish exactly where |p_N| = B.

#include "shape/fractals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shape/fractals.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

#include "shape/vector_math-inl.h"

#ifndef EVENMESH_FRACTALS_ONCE
#define EVENMESH_FRACTALS_ONCE
namespace evenmesh {
namespace {

/// Steps of the iteration and the bound B on |p_N|.
constexpr int julia_steps = 16, bulb_steps = 12;
constexpr float bound = 2.0f;
/// |p| at which an orbit counts as escaped: far beyond B, so that f is continuous, and small enough for the next power.
constexpr float julia_escape = 1e4f, bulb_escape = 32.0f;
/// Deep inside f means nothing; it is held here.
constexpr float deepest = -0.1f;

}  // namespace
}  // namespace evenmesh
#endif

HWY_BEFORE_NAMESPACE();
namespace evenmesh::HWY_NAMESPACE {
namespace {

/// |p_k|², dr_k and log B / n^(N−k) of the last step of each orbit; lanes stop where they escape.
struct Orbit {
  Floats squared, derivative, offset;
};

HWY_INLINE Floats field_of(const Orbit& orbit) {
  const FloatTag d;
  const Floats tiny = number(1e-30f), half = number(0.5f), limit = number(bound * bound);
  const Floats squared = hn::Max(orbit.squared, tiny), derivative = hn::Max(orbit.derivative, tiny);
  const Floats over = hn::Sub(hn::Mul(half, logarithm(squared)), orbit.offset);
  // Inside, |p| log|p| would vanish again at p = 0; B log|p| does not.
  const Floats size = hn::IfThenElse(hn::Gt(squared, limit), hn::Sqrt(squared), number(bound));
  return hn::Max(hn::Div(hn::Mul(size, over), derivative), hn::Set(d, deepest));
}

void run_julia(const float* c, std::size_t n, const float* x, const float* y, const float* z, float* values) {
  const FloatTag d;
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    Floats a = hn::LoadU(d, x + i), b = hn::LoadU(d, y + i), e = hn::LoadU(d, z + i), k = hn::Zero(d);
    Floats derivative = number(1.0f), offset = number(std::ldexp(std::log(bound), -julia_steps));
    const auto norm = [&]() HWY_ATTR {
      return hn::Add(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), hn::Add(hn::Mul(e, e), hn::Mul(k, k)));
    };
    Floats squared = norm();
    const Floats limit = number(julia_escape * julia_escape);
    for (int step = 0; step < julia_steps; ++step) {
      const auto going = hn::Le(squared, limit);
      if (hn::AllFalse(d, going)) break;
      const Floats two_a = hn::Add(a, a);
      const Floats next_a = hn::Sub(hn::Sub(hn::Mul(a, a), hn::Mul(b, b)), hn::Add(hn::Mul(e, e), hn::Mul(k, k)));
      derivative = hn::IfThenElse(going, hn::Mul(derivative, hn::Mul(number(2.0f), hn::Sqrt(squared))), derivative);
      offset = hn::IfThenElse(going, hn::Add(offset, offset), offset);
      b = hn::IfThenElse(going, hn::Add(hn::Mul(two_a, b), number(c[1])), b);
      e = hn::IfThenElse(going, hn::Add(hn::Mul(two_a, e), number(c[2])), e);
      k = hn::IfThenElse(going, hn::Add(hn::Mul(two_a, k), number(c[3])), k);
      a = hn::IfThenElse(going, hn::Add(next_a, number(c[0])), a);
      squared = norm();
    }
    hn::StoreU(field_of({squared, derivative, offset}), d, values + i);
  }
}

struct Complex {
  Floats re, im;
};
HWY_INLINE Complex times(const Complex& p, const Complex& q) {
  return {hn::Sub(hn::Mul(p.re, q.re), hn::Mul(p.im, q.im)), hn::Add(hn::Mul(p.re, q.im), hn::Mul(p.im, q.re))};
}
template <int degree>
HWY_INLINE Complex powered(const Complex& p) {
  const Complex p2 = times(p, p), p4 = times(p2, p2);
  return degree == 8 ? times(p4, p4) : times(times(p4, p2), p);
}

/// The polar angle is that of z + iρ with ρ = √(x² + y²), the azimuth that of (x + iy)/ρ: powers of two complex
/// numbers.
template <int degree>
void run_bulb(std::size_t n, const float* xs, const float* ys, const float* zs, float* values) {
  const FloatTag d;
  const Floats zero = hn::Zero(d), one = number(1.0f), limit = number(bulb_escape * bulb_escape);
  const float start = static_cast<float>(std::log(2.0) / std::pow(static_cast<double>(degree), bulb_steps));
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const Floats x0 = hn::LoadU(d, xs + i), y0 = hn::LoadU(d, ys + i), z0 = hn::LoadU(d, zs + i);
    Floats x = x0, y = y0, z = z0, derivative = one, offset = number(start);
    Floats flat = hn::Add(hn::Mul(x, x), hn::Mul(y, y)), squared = hn::Add(flat, hn::Mul(z, z));
    for (int step = 0; step < bulb_steps; ++step) {
      const auto going = hn::Le(squared, limit);
      if (hn::AllFalse(d, going)) break;
      const Floats rho = hn::Sqrt(flat), inverse = hn::IfThenElse(hn::Gt(rho, zero), hn::Div(one, rho), zero);
      const Complex polar = powered<degree>({z, rho}),
                    around = powered<degree>({hn::Mul(x, inverse), hn::Mul(y, inverse)});
      const Floats r = hn::Sqrt(squared), cube = hn::Mul(squared, squared);
      const Floats rn1 = degree == 8 ? hn::Mul(hn::Mul(cube, squared), r) : hn::Mul(cube, squared);  // r^(degree − 1)
      const Floats grown = hn::Add(hn::Mul(derivative, hn::Mul(number(degree), rn1)), one);
      derivative = hn::IfThenElse(going, grown, derivative);
      offset = hn::IfThenElse(going, hn::Mul(offset, number(degree)), offset);
      x = hn::IfThenElse(going, hn::Add(hn::Mul(polar.im, around.re), x0), x);
      y = hn::IfThenElse(going, hn::Add(hn::Mul(polar.im, around.im), y0), y);
      z = hn::IfThenElse(going, hn::Add(polar.re, z0), z);
      flat = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
      squared = hn::Add(flat, hn::Mul(z, z));
    }
    hn::StoreU(field_of({squared, derivative, offset}), d, values + i);
  }
}

void run_bulb7(std::size_t n, const float* x, const float* y, const float* z, float* values) {
  run_bulb<7>(n, x, y, z, values);
}
void run_bulb8(std::size_t n, const float* x, const float* y, const float* z, float* values) {
  run_bulb<8>(n, x, y, z, values);
}
std::size_t lanes() {
  return hn::Lanes(FloatTag());
}

}  // namespace
}  // namespace evenmesh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace evenmesh {
namespace {

HWY_EXPORT(run_julia);
HWY_EXPORT(run_bulb7);
HWY_EXPORT(run_bulb8);
HWY_EXPORT(lanes);

/// Runs a kernel that wants a multiple of the lanes: the last points go through padded copies.
template <typename Kernel>
void run_padded(const PointBatch& points, std::span<float> values, const Kernel& kernel) {
  constexpr std::size_t most = 256;
  const std::size_t count = values.size(), whole = count - count % HWY_DYNAMIC_DISPATCH(lanes)();
  kernel(whole, points.x.data(), points.y.data(), points.z.data(), values.data());
  std::array<std::array<float, most>, 4> rest{};
  const std::size_t left = std::min(count - whole, most);
  if (left == 0) return;
  std::copy_n(points.x.begin() + whole, left, rest[0].begin());
  std::copy_n(points.y.begin() + whole, left, rest[1].begin());
  std::copy_n(points.z.begin() + whole, left, rest[2].begin());
  kernel(left, rest[0].data(), rest[1].data(), rest[2].data(), rest[3].data());
  std::copy_n(rest[3].begin(), left, values.begin() + whole);
}

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Positive, negative or unknown: all that an enclosure of an orbit tells.
constexpr Interval outside{std::numeric_limits<float>::min(), infinity}, inside{deepest, 0.0},
    unknown{deepest, infinity};

double nearest_to_origin(const Box& box) {
  Vec3 p;
  for (int a = 0; a < 3; ++a) p[a] = std::max({box.lo[a], -box.hi[a], 0.0});
  return norm(p);
}

class Fractal : public Field {
 public:
  /// A normal at the scale of a fractal's finest detail is noise; this is the scale of a fine grid.
  double epsilon() const final { return 5e-4; }
};

class Julia final : public Fractal {
 public:
  explicit Julia(const std::array<double, 4>& c) : c_(c) {
    for (int i = 0; i < 4; ++i) single_[i] = static_cast<float>(c[i]);
  }

  using Field::evaluate;

  void evaluate(const PointBatch& points, std::span<float> values) const override {
    run_padded(points, values, [this](std::size_t n, const float* x, const float* y, const float* z, float* to) {
      HWY_DYNAMIC_DISPATCH(run_julia)(single_.data(), n, x, y, z, to);
    });
  }

  /// Iterates the ball around the box: |q² − q'²| ≤ (2|q| + ρ) ρ for |q − q'| ≤ ρ.
  Interval evaluate(const Box& box) const override {
    // |q| > 2 + |c| gives |q² + c| > 2|q| > B: the orbit never comes back.
    const double c = std::sqrt(c_[0] * c_[0] + c_[1] * c_[1] + c_[2] * c_[2] + c_[3] * c_[3]), never_returns = 2;
    const Vec3 p = box.center();
    std::array<double, 4> q{p.x, p.y, p.z, 0};
    double radius = 0.5 * box.diagonal() * (1 + 1e-6) + 1e-6, size = norm(p);
    for (int step = 0; step <= julia_steps; ++step) {
      if (size - radius > never_returns + c) return outside;
      if (!(radius < 4)) return unknown;
      if (step == julia_steps) break;
      radius = (2 * size + radius) * radius * (1 + 1e-6) + 1e-6;
      q = {q[0] * q[0] - q[1] * q[1] - q[2] * q[2] - q[3] * q[3] + c_[0], 2 * q[0] * q[1] + c_[1],
           2 * q[0] * q[2] + c_[2], 2 * q[0] * q[3] + c_[3]};
      size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    }
    return size + radius < bound ? inside : unknown;
  }

 private:
  std::array<double, 4> c_;
  std::array<float, 4> single_{};
};

class Mandelbulb final : public Fractal {
 public:
  explicit Mandelbulb(int degree) : degree_(degree) {}

  using Field::evaluate;

  void evaluate(const PointBatch& points, std::span<float> values) const override {
    run_padded(points, values, [this](std::size_t n, const float* x, const float* y, const float* z, float* to) {
      degree_ == 8 ? HWY_DYNAMIC_DISPATCH(run_bulb8)(n, x, y, z, to) : HWY_DYNAMIC_DISPATCH(run_bulb7)(n, x, y, z, to);
    });
  }

  /// Iterates the ball around the box. The n-th power stretches by n r^(n−1) along the polar angle and along r, and by
  /// n r^(n−1) |sin nθ / sin θ| ≤ n² r^(n−1) around the axis.
  Interval evaluate(const Box& box) const override {
    // r ≥ 1.17: rⁿ − r ≥ 1.83 > 1.17 for n ≥ 7, and the orbit grows from step to step.
    if (nearest_to_origin(box) > 1.18) return outside;
    const Vec3 start = box.center();
    const double spread = 0.5 * box.diagonal() * (1 + 1e-6) + 1e-6;
    Vec3 p = start;
    double radius = spread;
    for (int step = 0; step <= bulb_steps; ++step) {
      const double size = norm(p), most = size + radius;
      if (size - radius > bound + 0.5) return outside;
      if (!(most < 4)) return unknown;
      if (step == bulb_steps) break;
      radius = degree_ * degree_ * std::pow(most, degree_ - 1) * radius * (1 + 1e-6) + spread;
      const double polar = degree_ * std::atan2(std::hypot(p.x, p.y), p.z), azimuth = degree_ * std::atan2(p.y, p.x);
      p = start + std::pow(size, degree_) *
                      Vec3{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)};
    }
    return norm(p) + radius < bound ? inside : unknown;
  }

 private:
  int degree_;
};

}  // namespace

std::shared_ptr<const Field> make_julia(const std::array<double, 4>& c) {
  return std::make_shared<Julia>(c);
}

std::shared_ptr<const Field> make_mandelbulb(int degree) {
  return std::make_shared<Mandelbulb>(degree);
}

}  // namespace evenmesh
#endif  // HWY_ONCE
