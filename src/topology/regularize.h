#pragma once
/// Fewer vertices than the topology needs: balls on the places that do not fit together make it simpler.

#include <cstdint>
#include <span>
#include <vector>

#include "topology/balls.h"

namespace evenmesh {

/// A place that is not two-manifold: an edge between two seeds, or a point when both ends are the same.
struct BadEdge {
  Vec3 from, to;
};

/// Balls from the first round on, to be united with the solid round by round.
class RegularizationBalls {
 public:
  /// @param spacing  of the grid, h; @param edge  the mesh's wanted edge length, which places that are points have
  RegularizationBalls(double spacing, double edge) : spacing_(spacing), edge_(edge) {}

  /// For an edge of length l: balls of the last round that meet it grow by l0/20, up to the length l0 of the edge that
  /// they were put on, and then leave the list. Where none is met, new ones of radius l/2 are put on the edge,
  /// one for every two grid spacings of its shortest projection onto an axis.
  ///
  /// Returns the indices of the balls that are new or have grown. Cost: O(edges + balls). Deterministic.
  /// Based on [Raster2Mesh §4.4].
  std::vector<std::uint32_t> next_round(std::span<const BadEdge> edges);

  const std::vector<Ball>& balls() const { return balls_; }

 private:
  double spacing_, edge_;
  std::vector<Ball> balls_;
  std::vector<double> most_;           ///< radius of each ball at which it leaves the list
  std::vector<std::uint32_t> active_;  ///< the last round's balls that may still grow
};

}  // namespace evenmesh
