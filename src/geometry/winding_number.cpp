#include "geometry/winding_number.h"

#include <cmath>
#include <numbers>

namespace evenmesh {

double share_of_view(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 u = a - p, v = b - p, w = c - p;
  const double lu = norm(u), lv = norm(v), lw = norm(w);
  // van Oosterom, Strackee, The solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30, 1983.
  return std::atan2(dot(u, cross(v, w)), lu * lv * lw + dot(u, v) * lw + dot(v, w) * lu + dot(w, u) * lv) /
         (2 * std::numbers::pi);
}

double winding_number(const std::vector<Vec3>& vertices, std::span<const Triangle> triangles, const Vec3& p) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += share_of_view(vertices[t[0]], vertices[t[1]], vertices[t[2]], p);
  return sum;
}

}  // namespace evenmesh
