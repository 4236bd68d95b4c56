#pragma once
/// Balls united with a sampled solid: the local regularization of places that the grid cannot resolve.

#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "geometry/point_hash.h"
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
    const double r = reach + largest_;
    centers_.in_cells({p - Vec3{r, r, r}, p + Vec3{r, r, r}}, visit);
  }
  bool covers(const Vec3& p) const {
    bool covered = false;
    near(p, 0,
         [&](std::uint32_t b) { covered |= squared_norm(p - balls_[b].center) < balls_[b].radius * balls_[b].radius; });
    return covered;
  }
  /// The point itself, or, when it lies in balls, the nearest way out that a few steps find: in a crease to a
  /// thousandth of the radius.
  Vec3 outside(Vec3 p) const;

 private:
  std::vector<Ball> balls_;
  double largest_;  ///< radius
  PointHash centers_;
};

}  // namespace evenmesh
