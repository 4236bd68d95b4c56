#pragma once
/// Nearest neighbours among points.

#include <cstdint>
#include <span>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// A balanced k-d tree of different points: no grid, so that a point miles away does no harm.
///
/// Guarantee: same bits for any number of threads. Cost: O(n log n) to build, half a second per million points; about
/// 30 bytes each.
/// Based on Bentley, Multidimensional binary search trees used for associative searching, CACM 1975; bounds of the
/// search by Arya, Mount, Algorithms for fast vector quantization, DCC 1993.
class PointTree {
 public:
  /// @param points  finite; repeated ones are kept once
  PointTree(const std::vector<Vec3>& points, const ExecutionContext& context);

  /// How many different points there are.
  std::size_t size() const { return points_.size(); }
  /// The i-th of them; near ones have near numbers.
  Vec3 point(std::size_t i) const { return points_[i] * (1 / scale_); }
  /// Distances from p to the nearest points other than p itself, in ascending order.
  /// @param distances  as many as are wanted, below size(). Cost: some microseconds for a dozen.
  void nearest(const Vec3& p, std::span<double> distances) const;

 private:
  struct Split {
    double at = 0;
    std::uint8_t axis = 0;
  };
  struct Search;

  void build(const ExecutionContext& context);
  void search(std::size_t node, std::size_t begin, std::size_t end, Vec3 gap, double squared, Search& found) const;

  double scale_ = 1;           ///< power of two, so that squares neither overflow nor vanish
  std::vector<Vec3> points_;   ///< scaled; the leaves' points one behind the other
  std::vector<Split> splits_;  ///< of node i, children 2 i and 2 i + 1; the root is node 1
};

}  // namespace evenmesh
