#pragma once
/// The plane that points lie on as well as they can.

#include <array>
#include <cstddef>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Least squares of weighted points' distances from a plane: principal components.
///
/// Keep coordinates small, as from a place nearby: sums are of squares.
class PlaneFit {
 public:
  void add(const Vec3& p, double weight = 1) {
    ++count_;
    weight_ += weight;
    moment_ += weight * p;
    a_[0] += weight * p.x * p.x;
    a_[1] += weight * p.y * p.x;
    a_[2] += weight * p.z * p.x;
    a_[3] += weight * p.y * p.y;
    a_[4] += weight * p.z * p.y;
    a_[5] += weight * p.z * p.z;
  }
  std::size_t count() const { return count_; }

  struct Plane {
    Vec3 normal;                     ///< of length 1; which of both ways is left open
    std::array<double, 3> variance;  ///< of the points along the principal axes, ascending: the first along the normal
  };
  /// Of one point or more; less than three, or points on one line, leave the normal open.
  Plane plane() const;

 private:
  std::size_t count_ = 0;
  double weight_ = 0;
  Vec3 moment_;
  std::array<double, 6> a_{};  ///< second moments, lower triangle
};

}  // namespace evenmesh
