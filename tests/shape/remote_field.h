#pragma once
/// A field that stands for one on another device: calls are dear, points are cheap.

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "shape/field.h"

namespace evenmesh::testing {

/// Another field's values without its intervals, and a count of what it is asked. What is on a device already, with
/// enclosures that are somebody's word, is only counted.
class RemoteField final : public Field {
 public:
  /// @param slope  |f(p) − f(q)| ≤ slope · |p − q|, or so it is said: boxes are enclosed by f at their centres; 0: not
  /// known
  explicit RemoteField(std::shared_ptr<const Field> field, double slope = 0)
      : field_(std::move(field)), slope_(slope) {}

  void evaluate(const PointBatch& points, std::span<float> values) const override {
    count(points.x.size());
    field_->evaluate(points, values);
  }
  void evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx, std::span<float> dy,
                         std::span<float> dz) const override {
    count(points.x.size());
    field_->evaluate_gradient(points, values, dx, dy, dz);
  }
  Interval evaluate(const Box& box) const override {
    Interval range;
    enclose({&box, 1}, {&range, 1});
    return range;
  }
  void enclose(std::span<const Box> boxes, std::span<Interval> ranges) const override {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (slope_ > 0) count(boxes.size());
    if (!field_->encloses_surely()) return field_->enclose(boxes, ranges);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const double reach = slope_ * 0.5 * boxes[i].diagonal();
      const double middle = slope_ > 0 ? field_->evaluate(boxes[i].center(), nullptr) : 0;
      ranges[i] = slope_ > 0 ? Interval{middle - reach, middle + reach} : Interval{-infinity, infinity};
    }
  }
  double evaluate(const Vec3& point, Vec3* gradient) const override {
    ++single_points;
    count(1);
    return field_->evaluate(point, gradient);
  }
  double epsilon() const override { return field_->epsilon(); }
  bool has_gradient() const override { return field_->has_gradient(); }
  std::size_t batch_size() const override { return 262'144; }
  bool differentiates() const override { return field_->differentiates(); }
  const std::atomic<std::size_t>* non_finite_counter() const override { return field_->non_finite_counter(); }
  bool encloses_surely() const override { return field_->encloses_surely() && slope_ == 0; }

  mutable std::atomic<std::size_t> calls{0}, asked{0}, single_points{0};  ///< asked: points and boxes

 private:
  void count(std::size_t n) const { ++calls, asked += n; }

  std::shared_ptr<const Field> field_;
  double slope_;
};

}  // namespace evenmesh::testing
