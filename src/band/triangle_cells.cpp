#include "band/triangle_cells.h"

#include <cmath>
#include <cstdlib>

namespace evenmesh {
namespace {

using Wide = __int128;

// Cells that the point numerator / denominator touches, in cells; a point on a face touches two.
CellRange cells_at(std::int64_t numerator, std::int64_t denominator) {
  std::int64_t quotient = numerator / denominator;
  const std::int64_t rest = numerator % denominator;
  if (rest < 0) --quotient;
  const auto cell = static_cast<std::int32_t>(quotient);
  return {rest == 0 ? cell - 1 : cell, cell};
}

CellRange cells_at(std::int32_t coordinate, int bits) {
  const std::int32_t cell = coordinate >> bits;
  return {coordinate == cell << bits ? cell - 1 : cell, cell};
}

}  // namespace

CellBox cells_of_box(const LatticeTriangle& corners, int bits) {
  CellBox box;
  for (std::size_t a = 0; a < 3; ++a)
    for (const LatticePoint& p : corners) box[a].add(cells_at(p[a], bits));
  return box;
}

// What the triangle occupies along `across` in each slab of `axis`: calls add(slab, cells) for the corners in the slab
// and for where edges cross its two planes. The occupied cells are the hull of those.
template <typename Add>
void TriangleCells::cut_slabs(std::size_t axis, std::size_t across, const Add& add) const {
  const CellRange slabs = box_[axis];
  for (std::size_t i = 0; i < 3; ++i) {
    const LatticePoint& corner = corners_[i];
    const CellRange at = cells_at(corner[axis], bits_).cut(slabs), cells = cells_at(corner[across], bits_);
    for (std::int32_t s = at.first; s <= at.last; ++s) add(s, cells);
    const LatticePoint& next = corners_[(i + 1) % 3];
    if (corner[axis] == next[axis]) continue;
    const LatticePoint &a = corner[axis] < next[axis] ? corner : next, &b = corner[axis] < next[axis] ? next : corner;
    // Planes strictly between the ends; corners on a plane have been added already.
    const CellRange planes =
        CellRange{(a[axis] >> bits_) + 1, (b[axis] - 1) >> bits_}.cut({slabs.first, slabs.last + 1});
    const std::int64_t rise = std::int64_t{b[axis]} - a[axis], run = std::int64_t{b[across]} - a[across];
    for (std::int32_t m = planes.first; m <= planes.last; ++m) {
      const std::int64_t up = (std::int64_t{m} << bits_) - a[axis];
      const CellRange crossed = cells_at(a[across] * rise + up * run, rise << bits_);
      if (m > slabs.first) add(m - 1, crossed);
      if (m <= slabs.last) add(m, crossed);
    }
  }
}

void TriangleCells::set(const LatticeTriangle& corners, int bits, const CellBox& within) {
  corners_ = corners;
  bits_ = bits;
  box_ = cells_of_box(corners, bits);
  const bool one_cell = box_[0].first == box_[0].last && box_[1].first == box_[1].last && box_[2].first == box_[2].last;
  for (std::size_t a = 0; a < 3; ++a) box_[a] = box_[a].cut(within[a]);
  if (one_cell) {
    has_plane_ = false;
    rows_.assign(1, {box_[u_], box_[w_]});
    columns_.assign(1, box_[w_]);
    return;
  }
  set_plane();
  rows_.clear();
  columns_.clear();
  if (box_[0].empty() || box_[1].empty() || box_[2].empty()) {
    box_[v_] = {};
    return;
  }
  rows_.resize(box_[v_].count());
  columns_.resize(box_[u_].count());
  const auto row = [&](std::int32_t v) -> Row& { return rows_[static_cast<std::size_t>(v - box_[v_].first)]; };
  cut_slabs(v_, u_, [&](std::int32_t v, const CellRange& u) { row(v).u.add(u); });
  cut_slabs(v_, w_, [&](std::int32_t v, const CellRange& w) { row(v).w.add(w); });
  cut_slabs(u_, w_,
            [&](std::int32_t u, const CellRange& w) { columns_[static_cast<std::size_t>(u - box_[u_].first)].add(w); });
  for (Row& r : rows_) {
    r.u = r.u.cut(box_[u_]);
    r.w = r.w.cut(box_[w_]);
  }
}

void TriangleCells::set_plane() {
  const auto& [a, b, c] = corners_;
  const auto d = [](std::int32_t v, std::int32_t u) { return std::int64_t{v} - u; };
  const std::int64_t ux = d(b[0], a[0]), uy = d(b[1], a[1]), uz = d(b[2], a[2]);
  const std::int64_t vx = d(c[0], a[0]), vy = d(c[1], a[1]), vz = d(c[2], a[2]);
  normal_ = {uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
  w_ = 2;
  for (const std::size_t axis : {1, 0})
    if (std::abs(normal_[axis]) > std::abs(normal_[w_])) w_ = axis;
  u_ = w_ == 0 ? 1 : 0;
  v_ = w_ == 2 ? 1 : 2;
  has_plane_ = normal_[w_] != 0;
  if (!has_plane_) return;
  const double unit = std::ldexp(1.0, -bits_), steepest = static_cast<double>(normal_[w_]);
  slope_u_ = -static_cast<double>(normal_[u_]) / steepest;
  slope_v_ = -static_cast<double>(normal_[v_]) / steepest;
  anchor_u_ = a[u_] * unit;
  anchor_v_ = a[v_] * unit;
  low_ = a[w_] * unit + std::min(slope_u_, 0.0) + std::min(slope_v_, 0.0);
  high_ = a[w_] * unit + std::max(slope_u_, 0.0) + std::max(slope_v_, 0.0);
  // Slopes are at most 1, so nothing exceeds a few times the largest coordinate.
  double reach = 1;
  for (const std::size_t axis : {0, 1, 2})
    reach = std::max({reach, std::abs(a[axis] * unit), std::abs(static_cast<double>(box_[axis].first)),
                      std::abs(static_cast<double>(box_[axis].last))});
  near_ = reach * 0x1p-47;
}

// Whether the grid point (u, v, w) lies below the plane (-1), on it (0) or above it (1), seen along w.
int TriangleCells::side_of_plane(std::int32_t u, std::int32_t v, std::int32_t w) const {
  const auto term = [this](std::size_t axis, std::int32_t at) {
    return Wide{normal_[axis]} * ((std::int64_t{at} << bits_) - corners_[0][axis]);
  };
  const Wide sum = term(u_, u) + term(v_, v) + term(w_, w);
  const int sign = sum > 0 ? 1 : sum < 0 ? -1 : 0;
  return normal_[w_] > 0 ? sign : -sign;
}

// Replaces what rounding may have got wrong.
CellRange TriangleCells::settle(std::int32_t u, std::int32_t v, double low, double high, CellRange touched) const {
  const int near_low = floor_cell(low + 0.5), near_high = floor_cell(high + 0.5);
  if (std::abs(low - near_low) <= near_) {
    const int side = side_of_plane(u + (slope_u_ < 0 ? 1 : 0), v + (slope_v_ < 0 ? 1 : 0), near_low);
    touched.first = side >= 0 ? near_low - 1 : near_low;
  }
  if (std::abs(high - near_high) <= near_) {
    const int side = side_of_plane(u + (slope_u_ > 0 ? 1 : 0), v + (slope_v_ > 0 ? 1 : 0), near_high);
    touched.last = side <= 0 ? near_high : near_high - 1;
  }
  return touched;
}

}  // namespace evenmesh
