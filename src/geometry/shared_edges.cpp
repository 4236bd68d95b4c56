#include "geometry/shared_edges.h"

#include <algorithm>
#include <tuple>

namespace evenmesh {

std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = triangles[t][c], b = triangles[t][(c + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& x, const EdgeUse& y) {
    return std::tuple(x.low, x.high, x.triangle) < std::tuple(y.low, y.high, y.triangle);
  });
  return uses;
}

}  // namespace evenmesh
