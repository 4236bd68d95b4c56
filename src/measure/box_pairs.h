#pragma once
/// Which of many boxes overlap: the broad phase of self_intersections().

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// Boxes in groups of eight along a Morton curve, groups of groups above them. All tests are on float copies; since
/// rounding is monotone, boxes that overlap or touch in double precision also do in float.
class BoxPairs {
 public:
  static constexpr std::size_t width = 8;

  /// Empty boxes take part in no pair. Cost: some 50 ns per box.
  BoxPairs(const std::vector<Box>& boxes, const ExecutionContext& context);

  std::size_t groups() const { return order_.size() / width; }

  /// Calls found(i, j) once for every two boxes that overlap or touch and of which the one that comes first on the
  /// curve lies in `group`. Every pair belongs to exactly one group. Cost: logarithmic, plus the pairs.
  template <typename Found>
  void pairs_of_group(std::size_t group, const Found& found) const;

 private:
  /// Eight boxes, coordinate by coordinate: lo x, y, z, hi x, y, z.
  struct Eight {
    std::array<std::array<float, width>, 6> side;
    Eight() {
      for (int k = 0; k < 6; ++k)
        side[k].fill(k < 3 ? std::numeric_limits<float>::infinity() : -std::numeric_limits<float>::infinity());
    }
    std::array<float, 6> box(std::size_t i) const {
      return {side[0][i], side[1][i], side[2][i], side[3][i], side[4][i], side[5][i]};
    }
    /// Bit i is set when box i overlaps `b`.
    unsigned overlapping(const std::array<float, 6>& b) const {
      std::array<std::uint32_t, width> hit;
      for (std::size_t i = 0; i < width; ++i)
        hit[i] = static_cast<std::uint32_t>(side[0][i] <= b[3]) & static_cast<std::uint32_t>(side[1][i] <= b[4]) &
                 static_cast<std::uint32_t>(side[2][i] <= b[5]) & static_cast<std::uint32_t>(side[3][i] >= b[0]) &
                 static_cast<std::uint32_t>(side[4][i] >= b[1]) & static_cast<std::uint32_t>(side[5][i] >= b[2]);
      unsigned mask = 0;
      for (std::size_t i = 0; i < width; ++i) mask |= hit[i] << i;
      return mask;
    }
  };

  void sort_along_curve(const std::vector<Box>& boxes, const Box& all, const ExecutionContext& context);
  void build_levels(const ExecutionContext& context);

  /// Calls visit(g) for the groups g ≥ from of level 0 whose box overlaps `b`, below node `node` of `level`.
  template <typename Visit>
  void descend(std::size_t level, std::size_t node, std::size_t from, const std::array<float, 6>& b,
               const Visit& visit) const;

  std::vector<std::uint32_t> order_;        ///< boxes along the curve, padded to a multiple of eight
  std::vector<std::vector<Eight>> levels_;  ///< level 0 holds the boxes, level k + 1 the boxes of the groups of level k
};

template <typename Visit>
void BoxPairs::descend(std::size_t level, std::size_t node, std::size_t from, const std::array<float, 6>& b,
                       const Visit& visit) const {
  if (level == 0) {
    if (node >= from) visit(node);
    return;
  }
  for (unsigned mask = levels_[level][node].overlapping(b); mask != 0; mask &= mask - 1) {
    const std::size_t child = node * width + static_cast<std::size_t>(__builtin_ctz(mask));
    // The last group of level 0 below `child` tells whether anything there may still come after `from`.
    const std::size_t last = ((child + 1) << (3 * (level - 1))) - 1;
    if (last >= from) descend(level - 1, child, from, b, visit);
  }
}

template <typename Found>
void BoxPairs::pairs_of_group(std::size_t group, const Found& found) const {
  const Eight& own = levels_[0][group];
  std::array<float, 6> around = own.box(0);
  for (std::size_t i = 1; i < width; ++i)
    for (int k = 0; k < 6; ++k)
      around[k] = k < 3 ? std::min(around[k], own.side[k][i]) : std::max(around[k], own.side[k][i]);
  descend(levels_.size() - 1, 0, group, around, [&](std::size_t other) {
    for (std::size_t i = 0; i < width; ++i) {
      unsigned mask = levels_[0][other].overlapping(own.box(i));
      if (other == group) mask &= ~0u << (i + 1);
      for (; mask != 0; mask &= mask - 1)
        found(order_[group * width + i], order_[other * width + static_cast<std::size_t>(__builtin_ctz(mask))]);
    }
  });
}

}  // namespace evenmesh
