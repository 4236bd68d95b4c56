#pragma once
/// Implicit surfaces in plain loops, for the tests of this folder.

#include <cmath>
#include <memory>
#include <utility>
#include <variant>

#include "evenmesh/shape.h"
#include "shape/field.h"
#include "shape/forms.h"

namespace evenmesh {

/// f(x, y, z) of any callable, with numerical gradients and without intervals.
template <typename F>
class PlainField : public Field {
 public:
  explicit PlainField(F f, bool smooth = true) : f_(std::move(f)), smooth_(smooth) {}
  using Field::evaluate;
  void evaluate(const PointBatch& p, std::span<float> values) const override {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<float>(f_(double{p.x[i]}, double{p.y[i]}, double{p.z[i]}));
  }
  void evaluate_gradient(const PointBatch& p, std::span<float> values, std::span<float> dx, std::span<float> dy,
                         std::span<float> dz) const override {
    evaluate(p, values);
    const double e = 1e-5;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double x = p.x[i], y = p.y[i], z = p.z[i];
      dx[i] = static_cast<float>((f_(x + e, y, z) - f_(x - e, y, z)) / (2 * e));
      dy[i] = static_cast<float>((f_(x, y + e, z) - f_(x, y - e, z)) / (2 * e));
      dz[i] = static_cast<float>((f_(x, y, z + e) - f_(x, y, z - e)) / (2 * e));
    }
  }
  bool has_gradient() const override { return smooth_; }

 private:
  F f_;
  bool smooth_;
};

template <typename F>
Shape field_shape(F f, const Box& bounds, bool smooth = true) {
  return {"field", bounds, std::make_shared<const PlainField<F>>(std::move(f), smooth), false};
}

/// The same, asked for gradients as seldom as can be.
template <typename F>
class ExpensiveField final : public PlainField<F> {
 public:
  using PlainField<F>::PlainField;
  bool differentiates() const override { return false; }
};

/// The doubles of an expression one by one.
inline auto doubles_of(const Shape& shape) {
  return [exact = std::get<std::shared_ptr<const Field>>(shape.what)](double x, double y, double z) {
    return exact->evaluate(Vec3{x, y, z}, nullptr);
  };
}

/// Expressions without intervals, and such whose gradients are dear.
inline const testing::Form plain{
    .name = "plain", .of = [](const Shape& shape, double) { return field_shape(doubles_of(shape), shape.bounds); }};
inline const testing::Form expensive{.name = "dear",
                                     .of =
                                         [](const Shape& shape, double) {
                                           using Doubles = decltype(doubles_of(shape));
                                           Shape made = shape;
                                           made.what =
                                               std::make_shared<const ExpensiveField<Doubles>>(doubles_of(shape));
                                           return made;
                                         },
                                     .roots = 4e-3};

/// Ball of radius 1 with the interval of its distance.
class BallField : public Field {
 public:
  using Field::evaluate;
  void evaluate(const PointBatch& p, std::span<float> values) const override {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = p.x[i] * p.x[i] + p.y[i] * p.y[i] + p.z[i] * p.z[i] - 1.0f;
  }
  void evaluate_gradient(const PointBatch& p, std::span<float> values, std::span<float> dx, std::span<float> dy,
                         std::span<float> dz) const override {
    evaluate(p, values);
    for (std::size_t i = 0; i < values.size(); ++i) dx[i] = 2 * p.x[i], dy[i] = 2 * p.y[i], dz[i] = 2 * p.z[i];
  }
  Interval evaluate(const Box& box) const override {
    Interval sum{-1, -1};
    for (int a = 0; a < 3; ++a) {
      const double lo = box.lo[a], hi = box.hi[a], near = lo > 0 ? lo : hi < 0 ? hi : 0.0;
      sum.lo += near * near, sum.hi += std::max(lo * lo, hi * hi);
    }
    return sum;
  }
};

}  // namespace evenmesh
