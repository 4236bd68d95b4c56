#include "geometry/single_precision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace evenmesh {

double displacement(const Mesh& mesh, const std::vector<Vec3>& moved) {
  double worst = 0;
  for (const Triangle& t : mesh.triangles) {
    double longest = 0, farthest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& v = mesh.vertices[t[i]];
      longest = std::max(longest, squared_norm(mesh.vertices[t[(i + 1) % 3]] - v));
      farthest = std::max(farthest, squared_norm(moved[t[i]] - v));
      if (!is_finite(moved[t[i]])) return std::numeric_limits<double>::infinity();
    }
    if (longest > 0) worst = std::max(worst, farthest / longest);
  }
  return std::sqrt(worst);
}

std::vector<Vec3> in_single_precision(const std::vector<Vec3>& vertices) {
  // Not back and forth in one step: GCC 12 takes that, for two coordinates at once, for nothing to do.
  std::vector<std::array<float, 3>> single;
  single.reserve(vertices.size());
  for (const Vec3& v : vertices)
    single.push_back({static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
  std::vector<Vec3> rounded;
  rounded.reserve(vertices.size());
  for (const auto& [x, y, z] : single) rounded.push_back({x, y, z});
  return rounded;
}

bool fits_single_precision(const Mesh& mesh) {
  return displacement(mesh, in_single_precision(mesh.vertices)) <= single_precision_error;
}

}  // namespace evenmesh
