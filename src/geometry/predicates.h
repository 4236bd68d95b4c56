#pragma once
/// Exact signs of small determinants on double coordinates.
///
/// A floating-point filter answers nearly always; what is too close for it is summed up exactly by floating-point
/// expansions (Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, Discrete &
/// Computational Geometry 18, 1997). Exact as long as no product over- or underflows: coordinates and their non-zero
/// differences between 1e-80 and 1e95 in absolute value are safe. Needs a build without fused multiply-add contraction.

#include "evenmesh/mesh.h"

namespace evenmesh {

/// A point of a plane.
struct Point2 {
  double x = 0, y = 0;
};

/// A point without one coordinate, the other two in cyclic order: the sign of orient2d of three such points is the sign
/// of that component of their area normal.
inline Point2 drop_axis(const Vec3& p, int axis) {
  return axis == 0 ? Point2{p.y, p.z} : axis == 1 ? Point2{p.z, p.x} : Point2{p.x, p.y};
}

namespace detail {
constexpr double half_ulp = 0x1p-53;
// Error bounds of the plain evaluations relative to their permanents, Shewchuk §4.2 and §4.3.
constexpr double filter_2d = (3 + 16 * half_ulp) * half_ulp;
constexpr double filter_3d = (7 + 56 * half_ulp) * half_ulp;

int orient2d_exact(const Point2& a, const Point2& b, const Point2& c);
int orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
}  // namespace detail

/// Sign of (b − a) × (c − a): 1 when a, b, c turn left, -1 when they turn right, 0 when they are collinear.
/// Cost: 3 ns, some 0.1 µs when the filter fails.
inline int orient2d(const Point2& a, const Point2& b, const Point2& c) {
  const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x);
  const double determinant = left - right, bound = detail::filter_2d * (std::abs(left) + std::abs(right));
  if (determinant > bound) return 1;
  if (-determinant > bound) return -1;
  return detail::orient2d_exact(a, b, c);
}

/// Sign of ((b − a) × (c − a)) · (d − a): 1 when d lies on the side to which the normal of triangle a, b, c points
/// (from there a, b, c look counter-clockwise), -1 on the other side, 0 when the four are coplanar.
/// Cost: 5 ns, about a microsecond when the filter fails.
inline int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double uy_vz = u.y * v.z, uz_vy = u.z * v.y, uz_vx = u.z * v.x, ux_vz = u.x * v.z;
  const double ux_vy = u.x * v.y, uy_vx = u.y * v.x;
  const double determinant = w.x * (uy_vz - uz_vy) + w.y * (uz_vx - ux_vz) + w.z * (ux_vy - uy_vx);
  const double permanent = std::abs(w.x) * (std::abs(uy_vz) + std::abs(uz_vy)) +
                           std::abs(w.y) * (std::abs(uz_vx) + std::abs(ux_vz)) +
                           std::abs(w.z) * (std::abs(ux_vy) + std::abs(uy_vx));
  const double bound = detail::filter_3d * permanent;
  if (determinant > bound) return 1;
  if (-determinant > bound) return -1;
  return detail::orient3d_exact(a, b, c, d);
}

/// Whether three points lie on one line (two equal points do).
bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace evenmesh
