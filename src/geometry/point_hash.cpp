#include "geometry/point_hash.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace evenmesh {
namespace {

constexpr double farthest = (1 << 20) - 1;  ///< cells from the origin: what lies beyond is in the outermost
constexpr double always_asked = 1000;       ///< cells

}  // namespace

PointHash::PointHash(std::span<const Vec3> points, double side, const Vec3& origin) : PointHash(side, origin) {
  points_.reserve(points.size());
  next_.reserve(points.size());
  for (const Vec3& p : points) add(p);
}

void PointHash::add(const Vec3& p) {
  const Index at = cell_at(p);
  for (std::size_t a = 0; a < 3; ++a) {
    lowest_[a] = std::min(lowest_[a], at[a]);
    highest_[a] = std::max(highest_[a], at[a]);
  }
  const auto i = static_cast<std::uint32_t>(points_.size());
  points_.push_back(p);
  next_.push_back(none);
  Cell& cell = cells_[slot_of(key(at))];
  if (cell.first != none) {
    next_[cell.last] = i;
    cell.last = i;
    return;
  }
  cell = {key(at), i, i};
  if (2 * ++used_ > cells_.size()) grow();
}

void PointHash::grow() {
  std::vector<Cell> cells(2 * cells_.size());
  cells.swap(cells_);
  for (const Cell& cell : cells)
    if (cell.first != none) cells_[slot_of(cell.key)] = cell;
}

PointHash::Index PointHash::cell_at(const Vec3& p) const {
  const auto at = [&](int a) {
    return static_cast<std::int64_t>(std::clamp(std::floor((p[a] - origin_[a]) / side_), -farthest, farthest));
  };
  return {at(0), at(1), at(2)};
}

PointHash::Range PointHash::cells_of(const Box& box) const {
  Range range{cell_at(box.lo), cell_at(box.hi)};
  double count = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    range.lo[a] = std::max(range.lo[a], lowest_[a]);
    range.hi[a] = std::min(range.hi[a], highest_[a]);
    count *= static_cast<double>(std::max<std::int64_t>(range.hi[a] - range.lo[a] + 1, 0));
  }
  range.all = count > std::max(always_asked, static_cast<double>(points_.size()));
  return range;
}

}  // namespace evenmesh
