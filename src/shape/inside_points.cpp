#include "shape/inside_points.h"

#include <cmath>
#include <vector>

namespace evenmesh {
namespace {

/// Points on their way to the field.
class Asker {
 public:
  explicit Asker(const Field& field) : field_(field), batch_(field.batch_size()) {}

  void ask(float x, float y, float z) {
    x_.push_back(x);
    y_.push_back(y);
    z_.push_back(z);
    if (x_.size() >= batch_) flush();
  }
  InsidePoints result() {
    flush();
    return found_;
  }

 private:
  void flush() {
    if (x_.empty()) return;
    values_.resize(x_.size());
    field_.evaluate(PointBatch{x_, y_, z_}, values_);
    found_.asked += x_.size();
    for (const float value : values_) {
      found_.numbers += std::isfinite(value);
      found_.least = value < found_.least ? value : found_.least;
    }
    for (std::size_t i = 0; i < x_.size(); ++i)
      if (values_[i] < 0) {
        found_.box.add({x_[i], y_[i], z_[i]});
        ++found_.inside;
      }
    x_.clear();
    y_.clear();
    z_.clear();
  }

  const Field& field_;
  std::size_t batch_;
  std::vector<float> x_, y_, z_, values_;
  InsidePoints found_;
};

bool is_within(double value, const Box& box, int axis) {
  return value > box.lo[axis] && value < box.hi[axis];
}

}  // namespace

InsidePoints inside_points(const Field& field, const Box& box, const std::array<int, 3>& cells, const Box& hole) {
  std::array<std::vector<float>, 3> at;
  for (int a = 0; a < 3; ++a) {
    const int n = cells[static_cast<std::size_t>(a)];
    const double step = n > 0 ? (box.hi[a] - box.lo[a]) * (1.0 / n) : 0;
    for (int i = 0; i <= n; ++i) at[static_cast<std::size_t>(a)].push_back(static_cast<float>(box.lo[a] + step * i));
  }
  Asker asker(field);
  for (const float z : at[2])
    for (const float y : at[1]) {
      const bool through = is_within(y, hole, 1) && is_within(z, hole, 2);
      for (const float x : at[0])
        if (!through || !is_within(x, hole, 0)) asker.ask(x, y, z);
    }
  return asker.result();
}

}  // namespace evenmesh
