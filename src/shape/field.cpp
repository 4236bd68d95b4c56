#include "shape/field.h"

#include <array>
#include <limits>

namespace evenmesh {
namespace {

constexpr std::size_t chunk = 256;

/// One axis of a numerical gradient: (f(p + e) − f(p − e)) over the difference of the rounded coordinates.
void differentiate_axis(const Field& field, const PointBatch& points, int axis, float step,
                        std::span<float> derivative) {
  std::array<std::span<const float>, 3> coordinates{points.x, points.y, points.z};
  const std::size_t count = derivative.size();
  std::array<float, chunk> moved, above, below, apart;
  for (std::size_t begin = 0; begin < count; begin += chunk) {
    const std::size_t n = std::min(chunk, count - begin);
    std::array<std::span<const float>, 3> piece;
    for (int a = 0; a < 3; ++a) piece[a] = coordinates[a].subspan(begin, n);
    const std::span<const float> at = piece[axis];
    piece[axis] = std::span<const float>(moved.data(), n);
    for (std::size_t i = 0; i < n; ++i) moved[i] = at[i] + step;
    field.evaluate(PointBatch{piece[0], piece[1], piece[2]}, std::span<float>(above.data(), n));
    std::copy_n(moved.begin(), n, apart.begin());
    for (std::size_t i = 0; i < n; ++i) moved[i] = at[i] - step;
    field.evaluate(PointBatch{piece[0], piece[1], piece[2]}, std::span<float>(below.data(), n));
    for (std::size_t i = 0; i < n; ++i) derivative[begin + i] = (above[i] - below[i]) / (apart[i] - moved[i]);
  }
}

}  // namespace

void Field::evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx,
                              std::span<float> dy, std::span<float> dz) const {
  evaluate(points, values);
  const float step = static_cast<float>(epsilon());
  differentiate_axis(*this, points, 0, step, dx);
  differentiate_axis(*this, points, 1, step, dy);
  differentiate_axis(*this, points, 2, step, dz);
}

Interval Field::evaluate(const Box&) const {
  return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
}

void Field::enclose(std::span<const Box> boxes, std::span<Interval> ranges) const {
  for (std::size_t i = 0; i < boxes.size(); ++i) ranges[i] = evaluate(boxes[i]);
}

double Field::evaluate(const Vec3& point, Vec3* gradient) const {
  const float x = static_cast<float>(point.x), y = static_cast<float>(point.y), z = static_cast<float>(point.z);
  const PointBatch batch{{&x, 1}, {&y, 1}, {&z, 1}};
  float value = 0;
  if (gradient == nullptr) {
    evaluate(batch, {&value, 1});
    return value;
  }
  float dx = 0, dy = 0, dz = 0;
  evaluate_gradient(batch, {&value, 1}, {&dx, 1}, {&dy, 1}, {&dz, 1});
  *gradient = {dx, dy, dz};
  return value;
}

std::shared_ptr<const Field> Field::specialized(const Box&) const {
  return nullptr;
}

}  // namespace evenmesh
