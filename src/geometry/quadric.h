#pragma once
/// Where planes meet: the quadric error function.

#include <array>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Weighted sum of squared distances from planes, Σ w (n·(x − p))², and from points that x is drawn to.
///
/// Keep coordinates small, as from a place nearby: sums are of squares.
/// Based on Garland, Heckbert, Surface simplification using quadric error metrics, SIGGRAPH 1997; minima by Ju et al.,
/// Dual contouring of Hermite data, SIGGRAPH 2002.
class Quadric {
 public:
  /// @param n  of length 1
  void add_plane(const Vec3& p, const Vec3& n, double weight = 1) {
    weight_ += weight;
    moment_ += weight * p;
    b_ += (weight * dot(n, p)) * n;
    const Vec3 m = weight * n;
    a_[0] += m.x * n.x;
    a_[1] += m.x * n.y;
    a_[2] += m.x * n.z;
    a_[3] += m.y * n.y;
    a_[4] += m.y * n.z;
    a_[5] += m.z * n.z;
  }
  /// Draws minima to a point, by weight · |x − p|². It does not count in weight() and mean().
  void add_point(const Vec3& p, double weight) {
    b_ += weight * p;
    a_[0] += weight;
    a_[3] += weight;
    a_[5] += weight;
  }
  void add(const Quadric& other);

  double weight() const { return weight_; }        ///< of all planes
  Vec3 mean() const { return moment_ / weight_; }  ///< of the planes' points p

  /// Σ w (n·(x − p))², less what it is at the origin; and half its gradient.
  double excess(const Vec3& x) const { return dot(x, half_gradient(x) - b_); }
  Vec3 half_gradient(const Vec3& x) const {
    return Vec3{a_[0] * x.x + a_[1] * x.y + a_[2] * x.z, a_[1] * x.x + a_[3] * x.y + a_[4] * x.z,
                a_[2] * x.x + a_[4] * x.y + a_[5] * x.z} -
           b_;
  }

  /// The minimum. There has to be one: planes of three directions, or a point; otherwise the result is not finite.
  Vec3 minimum() const;
  /// The point nearest to mean() among those where the planes meet as well as they can. Directions in which they hardly
  /// differ do not count, but the `least` strongest ones do; at most `most` do.
  Vec3 minimum(int least, int most) const;
  /// In how many directions the planes differ by more than hardly.
  int rank() const;

 private:
  double weight_ = 0;
  Vec3 moment_, b_;
  std::array<double, 6> a_{};  ///< upper triangle
};

}  // namespace evenmesh
