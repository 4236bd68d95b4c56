#pragma once
/// Shape of one triangle.

#include <cmath>
#include <numbers>

#include "geometry/predicates.h"
#include "geometry/triangle.h"

namespace evenmesh {

struct TriangleQuality {
  double q = 0;               ///< 6·area / (√3 · half perimeter · longest edge), 1 = equilateral, 0 = degenerate
  double area = 0;            ///< model units squared
  double smallest_angle = 0;  ///< degrees
  double largest_angle = 0;   ///< degrees
};

/// Q as in Raster2Mesh §5; angles lie opposite the shortest and the longest edge.
inline TriangleQuality triangle_quality(const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double degrees = 180 / std::numbers::pi;
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const double squared[3] = {squared_norm(bc), squared_norm(ca), squared_norm(ab)};  // opposite a, b, c
  // |u| |v| cos(angle); "0 −", for a negative zero would turn the angle of a degenerate triangle around.
  const double at_corner[3] = {0 - dot(ab, ca), 0 - dot(bc, ab), 0 - dot(ca, bc)};
  const double twice_area = norm(cross(ab, bc));
  int shortest = 0, longest = 0;
  for (int k = 1; k < 3; ++k) {
    if (squared[k] < squared[shortest]) shortest = k;
    if (squared[k] > squared[longest]) longest = k;
  }
  TriangleQuality t;
  t.area = 0.5 * twice_area;
  const double half_perimeter = 0.5 * (std::sqrt(squared[0]) + std::sqrt(squared[1]) + std::sqrt(squared[2]));
  if (half_perimeter > 0) t.q = 6 * t.area / (std::sqrt(3.0) * half_perimeter * std::sqrt(squared[longest]));
  t.smallest_angle = std::atan2(twice_area, at_corner[shortest]) * degrees;
  t.largest_angle = std::atan2(twice_area, at_corner[longest]) * degrees;
  return t;
}

/// Whether a triangle has a repeated vertex or collinear corners, exactly.
inline bool is_degenerate(const Mesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
  return collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
}

}  // namespace evenmesh
