#pragma once
/// Points by cells of space.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Finds the points near a place; numbers them in the order in which they were added. Space is cut into cubic cells,
/// those that hold points are in a hash table: far outliers cost nothing.
///
/// Visits come in a fixed order: that of the cells by z, y, x, within a cell that of adding. Safe from several threads
/// while none is added. Cost: some 100 ns to add a point, 20 ns for every cell asked; up to 100 bytes per point.
/// Based on Teschner et al., Optimized spatial hashing for collision detection of deformable objects, VMV 2003, but
/// with the cells themselves as keys: what collides in the table is not mixed up.
class PointHash {
 public:
  /// @param side  of a cell, > 0: about as far as will be looked
  explicit PointHash(double side, const Vec3& origin = {}) : side_(side), origin_(origin), cells_(16) {}
  PointHash(std::span<const Vec3> points, double side, const Vec3& origin = {});

  /// @param p  finite; beyond a million cells from the origin finding becomes slow
  void add(const Vec3& p);
  std::size_t size() const { return points_.size(); }
  const Vec3& operator[](std::size_t i) const { return points_[i]; }

  /// Calls visit(i) for every point within `reach` of p. When it returns a bool: until that is true.
  /// @return whether it was
  template <typename Visit>
  bool near(const Vec3& p, double reach, const Visit& visit) const {
    const Vec3 r{reach, reach, reach};
    return in_cells({p - r, p + r}, [&](std::uint32_t i) {
      return squared_norm(points_[i] - p) <= reach * reach && is_enough(visit, i);
    });
  }
  /// The same for every point in the cells that a box touches, and perhaps for some others.
  template <typename Visit>
  bool in_cells(const Box& box, const Visit& visit) const {
    const Range range = cells_of(box);
    if (range.all) {
      for (std::uint32_t i = 0; i < points_.size(); ++i)
        if (is_enough(visit, i)) return true;
      return false;
    }
    for (std::int64_t k = range.lo[2]; k <= range.hi[2]; ++k)
      for (std::int64_t j = range.lo[1]; j <= range.hi[1]; ++j)
        for (std::int64_t i = range.lo[0]; i <= range.hi[0]; ++i)
          for (std::uint32_t p = cells_[slot_of(key({i, j, k}))].first; p != none; p = next_[p])
            if (is_enough(visit, p)) return true;
    return false;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  static constexpr std::int64_t outside = 1 << 21;
  using Index = std::array<std::int64_t, 3>;
  struct Cell {
    std::uint64_t key = 0;
    std::uint32_t first = none, last = none;  ///< of the cell's points; none: the slot is free
  };
  struct Range {
    Index lo, hi;
    bool all = false;  ///< there are so many cells that all points are asked instead
  };

  template <typename Visit>
  static bool is_enough(const Visit& visit, std::uint32_t i) {
    if constexpr (std::is_same_v<std::invoke_result_t<const Visit&, std::uint32_t>, bool>) {
      return visit(i);
    } else {
      visit(i);
      return false;
    }
  }
  static std::uint64_t key(const Index& cell) {
    constexpr std::int64_t middle = 1 << 20;
    return std::uint64_t(cell[2] + middle) << 42 | std::uint64_t(cell[1] + middle) << 21 |
           std::uint64_t(cell[0] + middle);
  }
  /// Where the cell is, or would be.
  std::size_t slot_of(std::uint64_t key) const {
    const std::size_t mask = cells_.size() - 1;
    std::size_t slot = (key * 0x9e3779b97f4a7c15ull >> 32) & mask;
    while (cells_[slot].first != none && cells_[slot].key != key) slot = (slot + 1) & mask;
    return slot;
  }
  Index cell_at(const Vec3& p) const;
  Range cells_of(const Box& box) const;
  void grow();

  double side_;
  Vec3 origin_;
  std::vector<Vec3> points_;
  std::vector<std::uint32_t> next_;  ///< by point: the next one of its cell
  std::vector<Cell> cells_;          ///< open addressing; a power of two, half full at most
  std::size_t used_ = 0;
  Index lowest_{outside, outside, outside}, highest_{-outside, -outside, -outside};  ///< cells with points
};

}  // namespace evenmesh
