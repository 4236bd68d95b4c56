#include "shape/field.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

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

/// The same bits by as few calls as possible: each point's star of seven in one.
void differentiate_at_once(const Field& field, const PointBatch& points, float step, std::span<float> values,
                           const std::array<std::span<float>, 3>& derivative) {
  const std::array<std::span<const float>, 3> coordinates{points.x, points.y, points.z};
  const std::size_t most = std::max<std::size_t>(field.batch_size() / 7, chunk);
  std::array<std::vector<float>, 3> star;
  std::vector<float> f;
  for (std::size_t begin = 0; begin < values.size(); begin += most) {
    const std::size_t n = std::min(most, values.size() - begin);
    f.resize(7 * n);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto at = coordinates[a].subspan(begin, n);
      star[a].resize(7 * n);
      for (std::size_t s = 0; s < 7; ++s) std::copy(at.begin(), at.end(), &star[a][s * n]);
      for (std::size_t i = 0; i < n; ++i) {
        star[a][(1 + 2 * a) * n + i] = at[i] + step;
        star[a][(2 + 2 * a) * n + i] = at[i] - step;
      }
    }
    field.evaluate({star[0], star[1], star[2]}, f);
    std::copy_n(f.begin(), n, &values[begin]);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t i = 0, up = (1 + 2 * a) * n, down = up + n; i < n; ++i, ++up, ++down)
        derivative[a][begin + i] = (f[up] - f[down]) / (star[a][up] - star[a][down]);
  }
}

}  // namespace

void Field::evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx,
                              std::span<float> dy, std::span<float> dz) const {
  const float step = static_cast<float>(epsilon());
  if (prefers_batches(*this)) return differentiate_at_once(*this, points, step, values, {dx, dy, dz});
  evaluate(points, values);
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
