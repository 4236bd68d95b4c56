#include "shape/affine_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "evenmesh/error.h"
#include "shape/local_origin.h"

namespace evenmesh {
namespace {

class AffineField final : public Field {
 public:
  /// @param precisely  ask the field in double precision
  AffineField(std::shared_ptr<const Field> field, const Affine& back, bool precisely = false)
      : field_(std::move(field)), back_(back), precisely_(precisely) {}

  void evaluate(const PointBatch& points, std::span<float> values) const override {
    if (precisely_) {
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(field_->evaluate(back_(point(points, i)), nullptr));
      return;
    }
    const Moved moved(points, back_);
    field_->evaluate(moved.batch(), values);
  }
  void evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx, std::span<float> dy,
                         std::span<float> dz) const override {
    const auto put = [&](std::size_t i, const Vec3& g) {
      dx[i] = static_cast<float>(g.x);
      dy[i] = static_cast<float>(g.y);
      dz[i] = static_cast<float>(g.z);
    };
    if (precisely_) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        Vec3 g;
        values[i] = static_cast<float>(evaluate(point(points, i), &g));
        put(i, g);
      }
      return;
    }
    const Moved moved(points, back_);
    field_->evaluate_gradient(moved.batch(), values, dx, dy, dz);
    for (std::size_t i = 0; i < values.size(); ++i) put(i, gradient({dx[i], dy[i], dz[i]}));
  }
  Interval evaluate(const Box& box) const override { return field_->evaluate(transformed_box(box, back_)); }
  void enclose(std::span<const Box> boxes, std::span<Interval> ranges) const override {
    std::vector<Box> moved;
    moved.reserve(boxes.size());
    for (const Box& box : boxes) moved.push_back(transformed_box(box, back_));
    field_->enclose(moved, ranges);
  }
  std::size_t batch_size() const override { return field_->batch_size(); }
  const std::atomic<std::size_t>* non_finite_counter() const override { return field_->non_finite_counter(); }
  bool differentiates() const override { return field_->differentiates(); }
  bool encloses_surely() const override { return field_->encloses_surely(); }
  double evaluate(const Vec3& point, Vec3* g) const override {
    const double value = field_->evaluate(back_(point), g);
    if (g) *g = gradient(*g);
    return value;
  }
  std::shared_ptr<const Field> specialized(const Box& box) const override {
    std::shared_ptr<const Field> inner = field_->specialized(transformed_box(box, back_));
    return inner ? std::make_shared<AffineField>(std::move(inner), back_, precisely_) : nullptr;
  }
  double epsilon() const override { return field_->epsilon() / scale(); }
  bool has_gradient() const override { return field_->has_gradient(); }
  bool is_precise() const override { return field_->is_precise(); }

  const std::shared_ptr<const Field>& inner() const { return field_; }
  const Affine& back() const { return back_; }
  bool precisely() const { return precisely_; }
  /// Lengths of the field within per length outside.
  double scale() const { return std::cbrt(std::max(1e-300, std::abs(back_.determinant()))); }
  std::shared_ptr<const Field> around(std::shared_ptr<const Field> field) const {
    const bool precisely = precisely_ && field->is_precise();
    return std::make_shared<AffineField>(std::move(field), back_, precisely);
  }

 private:
  static Vec3 point(const PointBatch& points, std::size_t i) { return {points.x[i], points.y[i], points.z[i]}; }

  struct Moved {
    std::vector<float> x, y, z;
    Moved(const PointBatch& points, const Affine& by) : x(points.x.size()), y(x.size()), z(x.size()) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        const Vec3 p = by({points.x[i], points.y[i], points.z[i]});
        x[i] = static_cast<float>(p.x);
        y[i] = static_cast<float>(p.y);
        z[i] = static_cast<float>(p.z);
      }
    }
    PointBatch batch() const { return {x, y, z}; }
  };
  Vec3 gradient(const Vec3& inner) const {
    return {dot(back_.column[0], inner), dot(back_.column[1], inner), dot(back_.column[2], inner)};
  }

  std::shared_ptr<const Field> field_;
  Affine back_;
  bool precisely_;
};

/// Signed distance from the nearest of a box's planes, negative within it, and the axis and sign of its gradient.
struct Wall {
  double distance = 0;
  int axis = 0;
  double sign = 1;
};
Wall wall_near(const Vec3& p, const Box& box) {
  Wall wall{box.lo.x - p.x, 0, -1};
  for (int a = 0; a < 3; ++a) {
    if (box.lo[a] - p[a] > wall.distance) wall = {box.lo[a] - p[a], a, -1};
    if (p[a] - box.hi[a] > wall.distance) wall = {p[a] - box.hi[a], a, 1};
  }
  return wall;
}

class BoxedField final : public Field {
 public:
  BoxedField(std::shared_ptr<const Field> field, const Box& box) : field_(std::move(field)), box_(box) {}

  void evaluate(const PointBatch& points, std::span<float> values) const override {
    field_->evaluate(points, values);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = std::max(values[i], static_cast<float>(wall_at(points, i).distance));
  }
  void evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx, std::span<float> dy,
                         std::span<float> dz) const override {
    field_->evaluate_gradient(points, values, dx, dy, dz);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Wall wall = wall_at(points, i);
      if (values[i] > static_cast<float>(wall.distance)) continue;
      values[i] = static_cast<float>(wall.distance);
      dx[i] = dy[i] = dz[i] = 0;
      (wall.axis == 0 ? dx : wall.axis == 1 ? dy : dz)[i] = static_cast<float>(wall.sign);
    }
  }
  Interval evaluate(const Box& box) const override { return within_walls(field_->evaluate(box), box); }
  void enclose(std::span<const Box> boxes, std::span<Interval> ranges) const override {
    field_->enclose(boxes, ranges);
    for (std::size_t i = 0; i < boxes.size(); ++i) ranges[i] = within_walls(ranges[i], boxes[i]);
  }
  std::size_t batch_size() const override { return field_->batch_size(); }
  const std::atomic<std::size_t>* non_finite_counter() const override { return field_->non_finite_counter(); }
  bool differentiates() const override { return field_->differentiates(); }
  bool encloses_surely() const override { return field_->encloses_surely(); }
  double evaluate(const Vec3& point, Vec3* gradient) const override {
    const double value = field_->evaluate(point, gradient);
    const Wall wall = wall_near(point, box_);
    if (value > wall.distance) return value;
    if (gradient) {
      *gradient = {};
      (*gradient)[wall.axis] = wall.sign;
    }
    return wall.distance;
  }
  std::shared_ptr<const Field> specialized(const Box& box) const override {
    std::shared_ptr<const Field> inner = field_->specialized(box);
    return inner ? std::make_shared<BoxedField>(std::move(inner), box_) : nullptr;
  }
  double epsilon() const override { return field_->epsilon(); }
  bool has_gradient() const override { return field_->has_gradient(); }
  bool is_precise() const override { return field_->is_precise(); }

  const std::shared_ptr<const Field>& inner() const { return field_; }
  const Box& box() const { return box_; }
  std::shared_ptr<const Field> around(std::shared_ptr<const Field> field) const {
    return std::make_shared<BoxedField>(std::move(field), box_);
  }

 private:
  Interval within_walls(const Interval& range, const Box& box) const {
    double lo = -std::numeric_limits<double>::infinity(), hi = lo;
    for (int a = 0; a < 3; ++a) {
      lo = std::max({lo, box_.lo[a] - box.hi[a], box.lo[a] - box_.hi[a]});
      hi = std::max({hi, box_.lo[a] - box.lo[a], box.hi[a] - box_.hi[a]});
    }
    return {std::max(range.lo, lo), std::max(range.hi, hi)};
  }
  Wall wall_at(const PointBatch& points, std::size_t i) const {
    return wall_near({points.x[i], points.y[i], points.z[i]}, box_);
  }

  std::shared_ptr<const Field> field_;
  Box box_;
};

}  // namespace

std::shared_ptr<const Field> boxed_field(std::shared_ptr<const Field> field, const Box& box) {
  return std::make_shared<BoxedField>(std::move(field), box);
}

std::shared_ptr<const Field> transformed_field(std::shared_ptr<const Field> field, const Affine& transform) {
  return std::make_shared<AffineField>(std::move(field), transform.inverse());
}

std::shared_ptr<const Field> shifted_field(std::shared_ptr<const Field> field, const Vec3& by, const Box& where) {
  if (const auto* boxed = dynamic_cast<const BoxedField*>(field.get()))
    return boxed_field(shifted_field(boxed->inner(), by, where), Box{boxed->box().lo - by, boxed->box().hi - by});
  Affine back = Affine::translate(by);
  while (const auto* moved = dynamic_cast<const AffineField*>(field.get())) {
    back = moved->back().after(back);
    field = std::shared_ptr<const Field>(moved->inner());
  }
  const bool far = local_origin(transformed_box(where, back)) != Vec3{};
  const bool precisely = far && field->is_precise();
  return std::make_shared<AffineField>(std::move(field), back, precisely);
}

double rounding_of(const Field& field, const Box& where) {
  if (const auto* boxed = dynamic_cast<const BoxedField*>(&field)) return rounding_of(*boxed->inner(), where);
  const auto* moved = dynamic_cast<const AffineField*>(&field);
  if (moved && moved->precisely()) return 0;
  if (moved) return rounding_of(*moved->inner(), transformed_box(where, moved->back())) / moved->scale();
  return local_origin(where) == Vec3{} ? 0 : single_rounding(where);
}

std::shared_ptr<const Field> with_innermost(const std::shared_ptr<const Field>& field, const Replacement& replace) {
  const auto within = [&](const auto& shell) -> std::shared_ptr<const Field> {
    std::shared_ptr<const Field> inner = with_innermost(shell.inner(), replace);
    return inner == shell.inner() ? field : shell.around(std::move(inner));
  };
  if (const auto* moved = dynamic_cast<const AffineField*>(field.get())) return within(*moved);
  if (const auto* boxed = dynamic_cast<const BoxedField*>(field.get())) return within(*boxed);
  return replace(field);
}

Box transformed_box(const Box& box, const Affine& transform) {
  if (box.empty()) return box;
  Box result;
  for (int corner = 0; corner < 8; ++corner)
    result.add(transform(
        {corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y, corner & 4 ? box.hi.z : box.lo.z}));
  return result;
}

Affine Affine::inverse() const {
  const double d = determinant();
  if (!(std::abs(d) > 0) || !std::isfinite(1 / d) || !is_finite(translation))
    throw InvalidInput("the transform is singular or not finite: it must not flatten the shape");
  const Vec3 rows[3] = {cross(column[1], column[2]) / d, cross(column[2], column[0]) / d,
                        cross(column[0], column[1]) / d};
  Affine result;
  for (int c = 0; c < 3; ++c) result.column[static_cast<std::size_t>(c)] = {rows[0][c], rows[1][c], rows[2][c]};
  result.translation = -result.direction(translation);
  return result;
}

Affine Affine::after(const Affine& first) const {
  Affine result;
  for (std::size_t c = 0; c < 3; ++c) result.column[c] = direction(first.column[c]);
  result.translation = (*this)(first.translation);
  return result;
}

Affine Affine::rotate(const Vec3& axis, double degrees) {
  const double length = norm(axis);
  if (!(length > 0) || !std::isfinite(length) || !std::isfinite(degrees))
    throw InvalidInput("a rotation needs an axis that is not zero and a finite angle");
  const Vec3 u = axis / length;
  const double turn = degrees * std::numbers::pi / 180, c = std::cos(turn), s = std::sin(turn);
  Affine result;
  const Vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t i = 0; i < 3; ++i)
    result.column[i] = c * unit[i] + s * cross(u, unit[i]) + (1 - c) * dot(u, unit[i]) * u;
  return result;
}

}  // namespace evenmesh
