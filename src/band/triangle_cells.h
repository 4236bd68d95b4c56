#pragma once
/// The cells of a cubic grid that a triangle touches, exactly.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "sample/lattice.h"

namespace evenmesh {

/// Cells first … last of one axis; empty when first > last.
struct CellRange {
  std::int32_t first = std::numeric_limits<std::int32_t>::max(), last = std::numeric_limits<std::int32_t>::min();

  bool empty() const { return first > last; }
  std::size_t count() const { return empty() ? 0 : static_cast<std::size_t>(last - first) + 1; }
  void add(const CellRange& r) {
    first = std::min(first, r.first);
    last = std::max(last, r.last);
  }
  CellRange cut(const CellRange& r) const { return {std::max(first, r.first), std::min(last, r.last)}; }
};
using CellBox = std::array<CellRange, 3>;

using LatticeTriangle = std::array<LatticePoint, 3>;

/// Cells of side 2^bits that the box around a triangle touches.
CellBox cells_of_box(const LatticeTriangle& corners, int bits);

/// Which closed cells a closed triangle touches: those for which none of the thirteen axes of the separating-axis test
/// separates the two. A triangle in a face counts for both sides; segments and points are triangles like others.
///
/// The nine axes edge × grid axis separate a cell and a triangle exactly when they separate the projections of both
/// along that grid axis. So a cell (u, v, w) is touched when w lies within what the triangle occupies in the slab v, in
/// the slab u, and within what its plane occupies over the square (u, v), and when u lies within what the triangle
/// occupies in the slab v: no cell is tested, ranges are cut. The walk goes along w, the plane's steepest axis.
/// After Schwarz, Seidel, Fast parallel surface and solid voxelization on GPUs, ToG 29(6), 2010.
///
/// Guarantee: exact; 64- and 128-bit integers decide what double precision cannot. Cost: O(rows + cells).
class TriangleCells {
 public:
  /// Prepares the walk over the cells of side 2^bits in `within`; coordinates as in Lattice.
  void set(const LatticeTriangle& corners, int bits, const CellBox& within);

  /// Calls use(cell), cell an array of three coordinates, for each cell touched.
  template <typename Use>
  void for_each(const Use& use) const {
    std::array<std::int32_t, 3> cell{};
    for (std::int32_t v = box_[v_].first; v <= box_[v_].last; ++v) {
      const Row& row = rows_[static_cast<std::size_t>(v - box_[v_].first)];
      cell[v_] = v;
      for (std::int32_t u = row.u.first; u <= row.u.last; ++u) {
        const CellRange bounds = row.w.cut(columns_[static_cast<std::size_t>(u - box_[u_].first)]);
        const CellRange w = bounds.empty() ? bounds : plane_over(u, v, bounds);
        cell[u_] = u;
        for (cell[w_] = w.first; cell[w_] <= w.last; ++cell[w_]) use(cell);
      }
    }
  }

 private:
  /// What the triangle occupies between two neighbouring grid planes across v.
  struct Row {
    CellRange u, w;
  };

  void set_plane();
  static std::int32_t floor_cell(double v) {
    const auto cell = static_cast<std::int32_t>(v);
    return cell - (cell > v ? 1 : 0);
  }
  /// Cells of `bounds` that the plane touches over the square (u, v).
  CellRange plane_over(std::int32_t u, std::int32_t v, const CellRange& bounds) const {
    if (!has_plane_) return bounds;
    const double rise = (u - anchor_u_) * slope_u_ + (v - anchor_v_) * slope_v_;
    const double low = low_ + rise, high = high_ + rise;
    const CellRange touched{floor_cell(low), floor_cell(high)};
    const double in_low = low - touched.first, in_high = high - touched.last;
    const bool sure = in_low > near_ && in_low < 1 - near_ && in_high > near_ && in_high < 1 - near_;
    return bounds.cut(sure ? touched : settle(u, v, low, high, touched));
  }
  CellRange settle(std::int32_t u, std::int32_t v, double low, double high, CellRange touched) const;
  int side_of_plane(std::int32_t u, std::int32_t v, std::int32_t w) const;
  template <typename Add>
  void cut_slabs(std::size_t axis, std::size_t across, const Add& add) const;

  LatticeTriangle corners_{};
  int bits_ = 0;
  std::size_t u_ = 0, v_ = 1, w_ = 2;
  CellBox box_{};
  std::array<std::int64_t, 3> normal_{};
  bool has_plane_ = false;
  // The plane in cells, over the corner of (u, v) where it is lowest and where it is highest.
  double slope_u_ = 0, slope_v_ = 0, anchor_u_ = 0, anchor_v_ = 0, low_ = 0, high_ = 0, near_ = 0;
  std::vector<Row> rows_;
  std::vector<CellRange> columns_;
};

}  // namespace evenmesh
