#include "refine/untangle.h"

#include "refine/flips.h"

namespace evenmesh {
namespace {

/// Marks the vertices of the pairs' triangles and `rings` rings around them.
std::vector<char> region(const Mesh& mesh, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs,
                         int rings) {
  std::vector<char> in(mesh.vertices.size(), 0);
  for (const auto& [s, t] : pairs)
    for (int c = 0; c < 3; ++c) in[mesh.triangles[s][c]] = in[mesh.triangles[t][c]] = 1;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<char> wider = in;
    for (const Triangle& t : mesh.triangles)
      if (in[t[0]] || in[t[1]] || in[t[2]]) wider[t[0]] = wider[t[1]] = wider[t[2]] = 1;
    in.swap(wider);
  }
  return in;
}

/// Moves the marked vertices half way to the mean of their neighbours.
void smooth(Mesh& mesh, const std::vector<char>& marked, const Projector* projector) {
  std::vector<Vec3> sum(mesh.vertices.size());
  std::vector<int> count(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t v = t[c], w = t[(c + 1) % 3];  // every edge comes twice, once from each side
      if (marked[v]) sum[v] += mesh.vertices[w], ++count[v];
    }
  for (std::size_t v = 0; v < marked.size(); ++v) {
    if (!marked[v] || count[v] == 0) continue;
    const Vec3 mean = sum[v] / count[v], middle = 0.5 * (mesh.vertices[v] + mean);
    mesh.vertices[v] = projector ? projector->project(middle, norm(mean - mesh.vertices[v])) : middle;
  }
}

}  // namespace

std::size_t untangle(Mesh& mesh, const Projector* projector, const IntersectionFinder& find, Run& run) {
  constexpr int rounds = 12;
  auto pairs = find(mesh);
  Mesh best = mesh;
  std::size_t fewest = pairs.size();
  for (int round = 0; round < rounds && !pairs.empty(); ++round) {
    run.throw_if_cancelled();
    // First along the surface; where that does not help, freely: a smoother surface does not run through itself.
    smooth(mesh, region(mesh, pairs, round / 4), round % 4 < 2 ? projector : nullptr);
    flip_to_delaunay(mesh);
    pairs = find(mesh);
    if (pairs.size() < fewest) fewest = pairs.size(), best = mesh;
  }
  if (pairs.size() > fewest) mesh = std::move(best);
  return fewest;
}

}  // namespace evenmesh
