#include "geometry/subdivide.h"

#include <algorithm>

#include "geometry/half_edges.h"

namespace evenmesh {

SubdividedMesh subdivide(const Mesh& mesh, const ExecutionContext& context) {
  const HalfEdges half_edges(mesh.triangles, mesh.vertices.size(), context);
  SubdividedMesh result;
  result.mesh.vertices = mesh.vertices;
  std::vector<std::uint32_t> middle(3 * mesh.triangles.size());
  for (std::uint32_t h = 0; h < middle.size(); ++h) {
    const std::uint32_t opposite = half_edges.opposite(h);
    if (opposite < h) {
      middle[h] = middle[opposite];
      continue;
    }
    const Triangle& t = mesh.triangles[h / 3];
    const auto [a, b] = std::minmax(t[h % 3], t[(h + 1) % 3]);
    middle[h] = static_cast<std::uint32_t>(result.mesh.vertices.size());
    result.mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    result.edges.push_back({a, b});
  }
  result.mesh.triangles.reserve(4 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const std::uint32_t ab = middle[3 * t], bc = middle[3 * t + 1], ca = middle[3 * t + 2];
    for (const Triangle& part : {Triangle{a, ab, ca}, Triangle{b, bc, ab}, Triangle{c, ca, bc}, Triangle{ab, bc, ca}})
      result.mesh.triangles.push_back(part);
  }
  return result;
}

}  // namespace evenmesh
