#include "refine/vertex_constraints.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evenmesh {
namespace {

struct ChainPoint {
  Vec3 place;
  double arc = 0;  ///< length of the chain up to there
};

ChainPoint nearest_on(const CreaseChain& chain, const Vec3& p) {
  const std::vector<Vec3>& points = chain.points;
  double nearest = std::numeric_limits<double>::infinity();
  ChainPoint best{points.front(), 0};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3 along = points[i + 1] - points[i], from = p - points[i];
    const double length2 = squared_norm(along);
    const double share = length2 > 0 ? std::clamp(dot(from, along) / length2, 0.0, 1.0) : 0;
    if (const double d = squared_norm(from - share * along); d < nearest)
      nearest = d, best = {points[i] + share * along, chain.arc[i] + share * (chain.arc[i + 1] - chain.arc[i])};
  }
  return best;
}

/// Largest distance of the chain between two of its points from the chord; around a closed chain the shorter way.
double bulge_between(const CreaseChain& chain, const Vec3& p, const Vec3& q) {
  const auto [s, t] = std::minmax({nearest_on(chain, p).arc, nearest_on(chain, q).arc});
  const bool around = chain.points.front() == chain.points.back() && 2 * (t - s) > chain.length();
  const Vec3 along = q - p;
  const double length2 = squared_norm(along);
  double most = 0;
  for (std::size_t i = 0; i < chain.points.size(); ++i) {
    if ((chain.arc[i] > s && chain.arc[i] < t) == around) continue;
    const Vec3 from = chain.points[i] - p;
    const double share = length2 > 0 ? std::clamp(dot(from, along) / length2, 0.0, 1.0) : 0;
    most = std::max(most, squared_norm(from - share * along));
  }
  return std::sqrt(most);
}

}  // namespace

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
  return nearest_on(creases.chains[chain[v]], p).place;
}

double Holds::bulge(const Mesh& mesh, std::uint32_t v, std::span<const std::uint32_t> neighbours) const {
  double most = 0;
  for (const std::uint32_t w : neighbours)
    if (edge(v, w)) most = std::max(most, bulge_between(creases.chains[chain[v]], mesh.vertices[v], mesh.vertices[w]));
  return most;
}

}  // namespace evenmesh
