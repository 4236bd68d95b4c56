#pragma once
/// How far a triangle is from equilateral and from its size.

#include <cmath>
#include <numbers>
#include <span>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// (l1² + l2² + l3²) / (4 √3 A) − 1 + μ/2 · ln²(A / target): the conformal energy, 0 for an equilateral triangle and no
/// less for any other, and what size costs. No unit.
struct ShapeEnergy {
  double size_weight = 0.2;  ///< μ, 0 and above

  /// @param twice_area  of the triangle, above 0, and `twice_target` what it should be; model units squared
  double of(double squared_lengths, double twice_area, double twice_target) const {
    const double q = std::log(twice_area / twice_target);
    return squared_lengths / (2 * std::numbers::sqrt3 * twice_area) - 1 + 0.5 * size_weight * q * q;
  }
};

struct PlanePoint {
  double x = 0, y = 0;
};

/// Gradient and Hessian of the energy over moves of a vertex at the origin of a plane, from triangle to triangle. The
/// logarithm is approximated within 1 % from 0.7 to 1.4; its Hessian is that of Gauss and Newton.
class PlaneNewton {
 public:
  PlaneNewton(double size_weight, double twice_target) : size_weight_(size_weight), twice_target_(twice_target) {}

  /// The triangle of the origin, b and c; returns false where it is turned over or nearly has no area.
  bool add(const PlanePoint& b, const PlanePoint& c) {
    const double area = b.x * c.y - b.y * c.x;  // twice
    if (!(area > 0.02 * twice_target_)) return false;
    const double mx = b.y - c.y, my = c.x - b.x;  // its gradient
    const double per = 1 / area, per2 = per * per;
    const double sx = -2 * (b.x + c.x), sy = -2 * (b.y + c.y);
    const double squares = b.x * b.x + b.y * b.y + c.x * c.x + c.y * c.y + mx * mx + my * my;
    constexpr double k = 0.5 / std::numbers::sqrt3;
    const double size = 2 * (area - twice_target_) / (area + twice_target_);
    const double by_area = size_weight_ * size * per - k * squares * per2;
    const double twice_by_area = size_weight_ * per2 + 2 * k * squares * per2 * per;
    gx_ += k * sx * per + by_area * mx;
    gy_ += k * sy * per + by_area * my;
    hxx_ += 4 * k * per - 2 * k * sx * mx * per2 + twice_by_area * mx * mx;
    hxy_ += -k * (sx * my + sy * mx) * per2 + twice_by_area * mx * my;
    hyy_ += 4 * k * per - 2 * k * sy * my * per2 + twice_by_area * my * my;
    return true;
  }
  /// To where the model has its minimum.
  PlanePoint step() const {
    const double determinant = hxx_ * hyy_ - hxy_ * hxy_;
    if (!(determinant > 1e-6 * hxx_ * hyy_)) return {};
    return {(hxy_ * gy_ - hyy_ * gx_) / determinant, (hxy_ * gx_ - hxx_ * gy_) / determinant};
  }

 private:
  double size_weight_, twice_target_;
  double gx_ = 0, gy_ = 0, hxx_ = 0, hxy_ = 0, hyy_ = 0;
};

/// The share of the step, 1 at most, after which the triangle of the moved origin, b and c keeps a fifth of its area.
inline double most_shrunk(const PlanePoint& b, const PlanePoint& c, const PlanePoint& step) {
  const double area = b.x * c.y - b.y * c.x, growth = (b.y - c.y) * step.x + (c.x - b.x) * step.y;
  return growth < -0.8 * area ? -0.8 * area / growth : 1;
}

inline PlanePoint middle_of(std::span<const PlanePoint> points) {
  PlanePoint sum;
  for (const PlanePoint& p : points) sum = {sum.x + p.x, sum.y + p.y};
  const double n = static_cast<double>(points.size());
  return {sum.x / n, sum.y / n};
}

}  // namespace evenmesh
