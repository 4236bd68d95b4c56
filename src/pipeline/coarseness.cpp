#include "pipeline/coarseness.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "geometry/half_edges.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

/// Of the normals across an edge as long as the radius of curvature, radians.
constexpr double turn_of_radius = 1 / std::numbers::sqrt3;
constexpr double few = 0.05;  ///< share of the edges that may be longer

}  // namespace

Coarseness coarseness(const Mesh& mesh, const VertexConstraints& constraints, const ExecutionContext& context) {
  const HalfEdges edges(mesh.triangles, mesh.vertices.size(), context);
  std::vector<Vec3> normal(mesh.triangles.size());
  for (std::size_t t = 0; t < normal.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    normal[t] = normalized(cross(b - a, c - a));
  }
  std::vector<float> turns;
  for (std::size_t h = 0; h < 3 * normal.size(); ++h) {
    const std::uint32_t back = edges.opposite(h);
    if (back == HalfEdges::none || back < h) continue;
    const Triangle& t = mesh.triangles[h / 3];
    if (constraints.vertex(t[h % 3]) && constraints.vertex(t[(h + 1) % 3])) continue;
    turns.push_back(static_cast<float>(std::acos(std::clamp(dot(normal[h / 3], normal[back / 3]), -1.0, 1.0))));
  }
  if (turns.empty()) return {};
  const auto longer = std::count_if(turns.begin(), turns.end(), [](float turn) { return turn > turn_of_radius; });
  const auto last = turns.begin() + static_cast<std::ptrdiff_t>((1 - few) * static_cast<double>(turns.size() - 1));
  std::nth_element(turns.begin(), last, turns.end());
  const double ratio = *last / turn_of_radius;  // turns are as long as edges
  return {static_cast<double>(longer) / static_cast<double>(turns.size()), std::max(1.0, ratio * ratio)};
}

}  // namespace evenmesh
