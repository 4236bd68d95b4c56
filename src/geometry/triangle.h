#pragma once
/// Arithmetic on one triangle, in double precision.

#include <array>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Normal of length twice the area, pointing to the side from which a, b, c is counter-clockwise.
inline Vec3 area_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return cross(b - a, c - a);
}

inline double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * norm(area_normal(a, b, c));
}

/// The three corners of a triangle of a mesh.
inline std::array<Vec3, 3> corners_of(const Mesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// Sum over all triangles, model units squared.
inline double area_of(const Mesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    area += triangle_area(a, b, c);
  }
  return area;
}

/// The point of a triangle that is nearest to p; the triangle may be degenerate.
///
/// Error: some units in the last place of the largest coordinate difference.
/// Voronoi regions of the corners, the edges, the face in turn (Ericson, Real-Time Collision Detection, 2005, §5.1.5).
inline Vec3 closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double ab_ap = dot(ab, ap), ac_ap = dot(ac, ap);
  if (ab_ap <= 0 && ac_ap <= 0) return a;
  const Vec3 bp = p - b;
  const double ab_bp = dot(ab, bp), ac_bp = dot(ac, bp);
  if (ab_bp >= 0 && ac_bp <= ab_bp) return b;
  const Vec3 cp = p - c;
  const double ab_cp = dot(ab, cp), ac_cp = dot(ac, cp);
  if (ac_cp >= 0 && ab_cp <= ac_cp) return c;

  // Signed areas of p's projection against the edges, scaled by the triangle's: barycentric coordinates.
  const double w_c = ab_ap * ac_bp - ab_bp * ac_ap;
  if (w_c <= 0 && ab_ap >= 0 && ab_bp <= 0) {
    const double length = ab_ap - ab_bp;
    return length > 0 ? a + (ab_ap / length) * ab : a;
  }
  const double w_b = ab_cp * ac_ap - ab_ap * ac_cp;
  if (w_b <= 0 && ac_ap >= 0 && ac_cp <= 0) {
    const double length = ac_ap - ac_cp;
    return length > 0 ? a + (ac_ap / length) * ac : a;
  }
  const double w_a = ab_bp * ac_cp - ab_cp * ac_bp;
  const double along_b = ac_bp - ab_bp, along_c = ab_cp - ac_cp;
  if (w_a <= 0 && along_b >= 0 && along_c >= 0) {
    const double length = along_b + along_c;
    return length > 0 ? b + (along_b / length) * (c - b) : b;
  }
  const double sum = w_a + w_b + w_c;
  if (!(sum > 0)) return a;
  return a + (w_b / sum) * ab + (w_c / sum) * ac;
}

}  // namespace evenmesh
