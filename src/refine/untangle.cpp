#include "refine/untangle.h"

#include <algorithm>
#include <cmath>

#include "refine/flips.h"
#include "refine/polish.h"

namespace evenmesh {
namespace {

constexpr int polishing_rounds = 4;

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

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
      if (!marked[v]) continue;
      sum[v] += mesh.vertices[w];
      ++count[v];
    }
  for (std::size_t v = 0; v < marked.size(); ++v) {
    if (!marked[v] || count[v] == 0) continue;
    const Vec3 mean = sum[v] / count[v], middle = 0.5 * (mesh.vertices[v] + mean);
    mesh.vertices[v] = projector ? projector->project(middle, norm(mean - mesh.vertices[v])) : middle;
  }
}

/// Moves the marked vertices along their normals by `share` of the mean length of their edges.
void shift(Mesh& mesh, const std::vector<char>& marked, double share) {
  std::vector<Vec3> normal(mesh.vertices.size());
  std::vector<double> length(mesh.vertices.size(), 0);
  std::vector<int> count(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 n = cross(b - a, c - a);
    for (int i = 0; i < 3; ++i) {
      normal[t[i]] += n;
      length[t[i]] += norm(mesh.vertices[t[(i + 1) % 3]] - mesh.vertices[t[i]]);
      ++count[t[i]];
    }
  }
  for (std::size_t v = 0; v < marked.size(); ++v)
    if (marked[v] && count[v] > 0) mesh.vertices[v] += (share * length[v] / count[v]) * normalized(normal[v]);
}

/// The triangles around one knot of intersections, as a mesh of their own.
struct Patch {
  Mesh mesh;
  std::vector<std::uint32_t> vertices;  ///< in the whole mesh
  std::vector<char> movable;
};

/// The knot around pairs[first]: its pairs are those that share vertices, one ring included, with others of it; they
/// are taken off.
Patch take_cluster(const Mesh& mesh, Pairs& pairs, const VertexConstraints& constraints) {
  std::vector<char> in(mesh.vertices.size(), 0);
  Pairs cluster{pairs.front()};
  pairs.erase(pairs.begin());
  for (bool grown = true; grown;) {
    in = region(mesh, cluster, 1);
    grown = false;
    std::erase_if(pairs, [&](const auto& pair) {
      for (const std::uint32_t t : {pair.first, pair.second})
        for (const std::uint32_t v : mesh.triangles[t])
          if (in[v]) {
            cluster.push_back(pair);
            return grown = true;
          }
      return false;
    });
  }
  Box box;
  for (std::size_t v = 0; v < in.size(); ++v)
    if (in[v]) box.add(mesh.vertices[v]);
  const double margin = 0.5 * box.diagonal();
  box.lo -= {margin, margin, margin};
  box.hi += {margin, margin, margin};
  Patch patch;
  std::vector<std::uint32_t> index(mesh.vertices.size(), 0xffffffffu);
  for (const Triangle& t : mesh.triangles) {
    Box own;
    for (const std::uint32_t v : t) own.add(mesh.vertices[v]);
    bool apart = false;
    for (int a = 0; a < 3; ++a) apart |= own.lo[a] > box.hi[a] || own.hi[a] < box.lo[a];
    if (apart) continue;
    Triangle local{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = t[c];
      if (index[v] == 0xffffffffu) {
        index[v] = static_cast<std::uint32_t>(patch.vertices.size());
        patch.vertices.push_back(v);
        patch.mesh.vertices.push_back(mesh.vertices[v]);
        patch.movable.push_back(in[v] && !constraints.vertex(v));
      }
      local[c] = index[v];
    }
    patch.mesh.triangles.push_back(local);
  }
  return patch;
}

/// Tries one kind of motion after the other and keeps what is best; true if anything was gained.
bool separate(Patch& patch, const Projector* projector, const IntersectionFinder& find) {
  constexpr int motions = 4, steps = 6;
  const Mesh start = patch.mesh;
  const std::size_t before = find(start).size();
  std::size_t fewest = before;
  for (int motion = 0; motion < motions && fewest > 0; ++motion) {
    Mesh mesh = start;
    for (int step = 0; step < steps && fewest > 0; ++step) {
      if (motion < 2)
        shift(mesh, patch.movable, motion == 0 ? 0.07 : -0.07);  // thin walls thicker, narrow gaps wider
      else
        smooth(mesh, patch.movable, motion == 2 ? projector : nullptr);
      const std::size_t left = find(mesh).size();
      if (left >= fewest) continue;
      fewest = left;
      patch.mesh = mesh;
    }
  }
  return fewest < before;
}

/// Knot by knot, each with what helps there.
void separate_clusters(Mesh& mesh, Pairs pairs, const Projector* projector, const IntersectionFinder& find,
                       const VertexConstraints& constraints, ExecutionContext& context) {
  constexpr int max_clusters = 200;
  for (int cluster = 0; cluster < max_clusters && !pairs.empty(); ++cluster) {
    context.throw_if_cancelled();
    Patch patch = take_cluster(mesh, pairs, constraints);
    if (!separate(patch, projector, find)) continue;
    for (std::size_t v = 0; v < patch.vertices.size(); ++v)
      if (patch.movable[v]) mesh.vertices[patch.vertices[v]] = patch.mesh.vertices[v];
  }
}

/// Returns the number of pairs that are left.
std::size_t separate(Mesh& mesh, Pairs pairs, const Projector* projector, const IntersectionFinder& find,
                     ExecutionContext& context, const VertexConstraints& constraints) {
  constexpr int rounds = 12, cluster_rounds = 3;
  Mesh best = mesh;
  std::size_t fewest = pairs.size();
  for (int round = 0; round < rounds && !pairs.empty(); ++round) {
    context.throw_if_cancelled();
    // First along the surface; where that does not help, freely: a smoother surface does not run through itself.
    std::vector<char> marked = region(mesh, pairs, round / 4);
    for (std::uint32_t v = 0; v < marked.size(); ++v) marked[v] = marked[v] && !constraints.vertex(v);
    smooth(mesh, marked, round % 4 < 2 ? projector : nullptr);
    flip_to_delaunay(mesh, constraints, context);
    pairs = find(mesh);
    if (pairs.size() >= fewest) continue;
    fewest = pairs.size();
    best = mesh;
  }
  if (pairs.size() > fewest) mesh = std::move(best);
  if (fewest == 0) return 0;
  best = mesh;
  for (int round = 0; round < cluster_rounds && fewest > 0; ++round) {
    separate_clusters(mesh, find(mesh), projector, find, constraints, context);
    const std::size_t left = find(mesh).size();
    if (left >= fewest) break;
    fewest = left;
    best = mesh;
  }
  mesh = std::move(best);
  return fewest;
}

}  // namespace

std::size_t untangle(Mesh& mesh, const Projector* projector, const IntersectionFinder& find, ExecutionContext& context,
                     const VertexConstraints& constraints) {
  Pairs pairs = find(mesh);
  if (pairs.empty()) return 0;
  const std::size_t left = separate(mesh, std::move(pairs), projector, find, context, constraints);
  // What was pulled apart without regard to shapes is polished; where that would undo it, it stays as it is.
  Mesh polished = mesh;
  polish(polished, projector, context, constraints);
  for (int rings = 0; rings < polishing_rounds; ++rings) {
    const Pairs again = find(polished);
    if (again.size() <= left) {
      mesh = std::move(polished);
      break;
    }
    const std::vector<char> back = region(mesh, again, rings);
    for (std::size_t v = 0; v < back.size(); ++v)
      if (back[v]) polished.vertices[v] = mesh.vertices[v];
  }
  return left;
}

std::size_t undo_intersections(Mesh& mesh, const std::vector<Vec3>& before, const IntersectionFinder& find) {
  constexpr int most_rings = 8;
  Pairs pairs = find(mesh);
  for (int rings = 0; rings < most_rings && !pairs.empty(); ++rings) {
    const std::vector<char> back = region(mesh, pairs, rings);
    for (std::size_t v = 0; v < back.size(); ++v)
      if (back[v]) mesh.vertices[v] = before[v];
    pairs = find(mesh);
  }
  return pairs.size();
}

}  // namespace evenmesh
