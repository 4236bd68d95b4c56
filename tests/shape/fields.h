#pragma once
/// Helpers of the field tests: random points, evaluation of a whole set.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/random.h"
#include "evenmesh/shape.h"
#include "shape/field.h"

namespace evenmesh::testing {

inline std::shared_ptr<const Field> field_of(const Shape& shape) {
  return std::get<std::shared_ptr<const Field>>(shape.what);
}

inline std::shared_ptr<const Field> parse(std::string_view text, const std::map<std::string, double>& parameters = {}) {
  return field_of(shape_from_expression(text, parameters));
}

inline double value_at(const Field& field, const Vec3& p) {
  return field.evaluate(p, nullptr);
}

struct Points {
  std::vector<float> x, y, z;
  explicit Points(std::size_t count) : x(count), y(count), z(count) {}
  std::size_t size() const { return x.size(); }
  PointBatch batch() const { return {x, y, z}; }
  Vec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Points spread evenly over a box; the random numbers are the same in every run.
inline Points random_points(const Box& box, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Points points(count);
  const Vec3 size = box.size();
  for (std::size_t i = 0; i < count; ++i) {
    points.x[i] = static_cast<float>(box.lo.x + size.x * random.uniform());
    points.y[i] = static_cast<float>(box.lo.y + size.y * random.uniform());
    points.z[i] = static_cast<float>(box.lo.z + size.z * random.uniform());
  }
  return points;
}

struct Gradients {
  std::vector<float> values, dx, dy, dz;
  explicit Gradients(std::size_t count) : values(count), dx(count), dy(count), dz(count) {}
  Vec3 at(std::size_t i) const { return {dx[i], dy[i], dz[i]}; }
};

inline std::vector<float> values_at(const Field& field, const Points& points) {
  std::vector<float> values(points.size());
  field.evaluate(points.batch(), values);
  return values;
}

inline Gradients gradients_at(const Field& field, const Points& points) {
  Gradients g(points.size());
  field.evaluate_gradient(points.batch(), g.values, g.dx, g.dy, g.dz);
  return g;
}

/// A box within `outer`, between a thousandth and all of it along each axis.
inline Box random_box(const Box& outer, Random& random) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const double width = (outer.hi[axis] - outer.lo[axis]) * std::pow(10.0, -3.0 * random.uniform());
    box.lo[axis] = outer.lo[axis] + (outer.hi[axis] - outer.lo[axis] - width) * random.uniform();
    box.hi[axis] = box.lo[axis] + width;
  }
  return box;
}

}  // namespace evenmesh::testing
