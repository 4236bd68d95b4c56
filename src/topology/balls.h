#pragma once
/// Balls united with a sampled solid: the local regularization of places that the grid cannot resolve.

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

struct Ball {
  Vec3 center;
  double radius = 0;  ///< model units
};

/// The samples of the union of a sampled solid and some balls, on the same grid. Samples inside a ball are dropped, new
/// ones lie on the spheres; the outermost grid points stay outside. What is new weighs what the surface around
/// the ball does, area for area.
///
/// Guarantee: the samples bound a solid, in the order a SampleSet promises; same bits for any number of threads.
/// Cost: O(samples) for copying, and about a microsecond for every grid point near a ball.
/// Based on [Raster2Mesh §4.4].
SampleSet unite_balls(const SampleSet& samples, std::span<const Ball> balls, ExecutionContext& context);

/// Finds the balls around a point. Safe from several threads while none is added.
class BallIndex {
 public:
  /// @param largest_radius  of balls that will be added, model units
  explicit BallIndex(std::vector<Ball> balls, double largest_radius = 0);
  void add(const Ball& ball);
  const std::vector<Ball>& balls() const { return balls_; }
  /// Calls visit(ball index) for every ball within `reach` of p, and perhaps for some others, in a fixed order.
  template <typename Visit>
  void near(const Vec3& p, double reach, const Visit& visit) const {
    if (balls_.empty()) return;
    const auto lo = cell_of(p - Vec3{reach, reach, reach}), hi = cell_of(p + Vec3{reach, reach, reach});
    for (std::int64_t k = lo[2] - 1; k <= hi[2] + 1; ++k)
      for (std::int64_t j = lo[1] - 1; j <= hi[1] + 1; ++j)
        for (std::int64_t i = lo[0] - 1; i <= hi[0] + 1; ++i)
          if (const auto it = cells_.find(key(i, j, k)); it != cells_.end())
            for (const std::uint32_t b : it->second) visit(b);
  }
  /// The point itself, or, when it lies in balls, the nearest way out that a few steps find: in a crease to a
  /// thousandth of the radius.
  Vec3 outside(Vec3 p) const;

 private:
  std::array<std::int64_t, 3> cell_of(const Vec3& p) const;
  static std::int64_t key(std::int64_t i, std::int64_t j, std::int64_t k);

  std::vector<Ball> balls_;
  double side_ = 0;  ///< of a cell: the largest radius, so that balls reach one cell beyond their centre's
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace evenmesh
