#include "refine/holds.h"

#include <algorithm>
#include <limits>

namespace evenmesh {

bool Holds::edge(std::uint32_t a, std::uint32_t b) const {
  return vertex(a) && vertex(b) &&
         std::binary_search(edges.begin(), edges.end(), std::array{std::min(a, b), std::max(a, b)});
}

void Holds::release(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
  if (chain.empty()) return;
  for (const std::uint32_t t : triangles)
    for (const std::uint32_t v : mesh.triangles[t]) chain[v] = free;
}

Vec3 Holds::slide(std::uint32_t v, const Vec3& p) const {
  const std::vector<Vec3>& points = creases.chains[chain[v]].points;
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 best = points.front();
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3 along = points[i + 1] - points[i], from = p - points[i];
    const double length2 = squared_norm(along);
    const double share = length2 > 0 ? std::clamp(dot(from, along) / length2, 0.0, 1.0) : 0;
    if (const double d = squared_norm(from - share * along); d < nearest) nearest = d, best = points[i] + share * along;
  }
  return best;
}

}  // namespace evenmesh
