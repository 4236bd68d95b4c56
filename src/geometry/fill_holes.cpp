// Barequet, Sharir, Filling gaps in the boundary of a polyhedron, Computer Aided Geometric Design 12(2), 1995, §3;
// Jacobson, Kavan, Sorkine-Hornung, Robust inside-outside segmentation using generalized winding numbers, ToG 32(4),
// 2013.

#include <algorithm>
#include <cmath>
#include <limits>

#include "evenmesh/error.h"
#include "evenmesh/repair.h"
#include "geometry/hole_fills.h"
#include "geometry/shared_edges.h"
#include "geometry/triangle.h"
#include "geometry/winding_number.h"

namespace evenmesh {
namespace {

constexpr std::size_t longest_loop = 400;       ///< edges; the cost goes with the third power
constexpr std::size_t max_views = 100'000'000;  ///< of a fill's triangles from fills: some seconds
constexpr double max_astray = 0.25;             ///< of the winding number half way between inside and outside

constexpr std::uint32_t none = 0xffffffffu;

/// Boundary edges by where they start, directed so that a triangle for an edge faces as its neighbour does.
std::vector<std::pair<std::uint32_t, std::uint32_t>> boundary_edges(const Mesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> boundary;
  for_each_edge(edge_uses(mesh.triangles), [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 1) return;
    const auto& use = edge[0];
    boundary.push_back(use.up ? std::pair(use.high, use.low) : std::pair(use.low, use.high));
  });
  std::sort(boundary.begin(), boundary.end());
  return boundary;
}

/// Closed walks along the boundary. A walk that comes back to a vertex ends there, so each has every vertex once.
std::vector<std::vector<std::uint32_t>> boundary_loops(const Mesh& mesh) {
  const auto boundary = boundary_edges(mesh);
  std::vector<char> used(boundary.size(), 0);
  std::vector<std::uint32_t> place(mesh.vertices.size(), none);  // in the walk
  const auto leave = [&](std::uint32_t v) {
    auto edge = std::lower_bound(boundary.begin(), boundary.end(), std::pair(v, std::uint32_t{0}));
    while (edge != boundary.end() && edge->first == v && used[static_cast<std::size_t>(edge - boundary.begin())])
      ++edge;
    if (edge == boundary.end() || edge->first != v) return none;
    used[static_cast<std::size_t>(edge - boundary.begin())] = 1;
    return edge->second;
  };
  std::vector<std::vector<std::uint32_t>> loops;
  for (std::size_t first = 0; first < boundary.size(); ++first) {
    if (used[first]) continue;
    std::vector<std::uint32_t> walk;
    for (std::uint32_t v = boundary[first].first; v != none; v = leave(v)) {
      if (place[v] != none) {
        std::vector<std::uint32_t> loop(walk.begin() + place[v], walk.end());
        for (const std::uint32_t w : loop) place[w] = none;
        walk.resize(walk.size() - loop.size());
        if (loop.size() >= 3 && loop.size() <= longest_loop) loops.push_back(std::move(loop));
      }
      place[v] = static_cast<std::uint32_t>(walk.size());
      walk.push_back(v);
    }
    for (const std::uint32_t w : walk) place[w] = none;
  }
  return loops;
}

/// The triangulation of a closed loop that has the least area.
std::vector<Triangle> min_area_fill(const Mesh& mesh, const std::vector<std::uint32_t>& loop) {
  const std::size_t n = loop.size();
  std::vector<double> least(n * n, 0);  // area between the loop's vertices i … j and the chord from j to i
  std::vector<std::uint32_t> apex(n * n, 0);
  const auto at = [&](std::size_t i) { return mesh.vertices[loop[i]]; };
  for (std::size_t span = 2; span < n; ++span)
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t j = i + span;
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t k = i + 1; k < j; ++k)
        if (const double area = least[i * n + k] + least[k * n + j] + triangle_area(at(i), at(k), at(j)); area < best) {
          best = area;
          apex[i * n + j] = static_cast<std::uint32_t>(k);
        }
      least[i * n + j] = best;
    }
  std::vector<Triangle> fill;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i < 2) continue;
    const std::size_t k = apex[i * n + j];
    fill.push_back({loop[i], loop[k], loop[j]});
    open.push_back({i, k});
    open.push_back({k, j});
  }
  return fill;
}

}  // namespace

std::vector<std::vector<Triangle>> hole_fills(const Mesh& mesh) {
  std::vector<std::vector<Triangle>> fills;
  for (const auto& loop : boundary_loops(mesh)) fills.push_back(min_area_fill(mesh, loop));
  return fills;
}

std::vector<char> lie_half_way(const std::vector<Vec3>& vertices, std::span<const std::vector<Triangle>> fills) {
  std::size_t triangles = 0;
  for (const auto& fill : fills) triangles += fill.size();
  std::vector<char> half_way(fills.size(), 0);
  if (fills.size() * triangles > max_views) return half_way;
  // With all holes filled the winding number on a fill, between its two sides, is half an odd number. Without, it
  // differs from that by what is seen of the fills.
  const auto area = [&](const Triangle& t) { return triangle_area(vertices[t[0]], vertices[t[1]], vertices[t[2]]); };
  for (std::size_t i = 0; i < fills.size(); ++i) {
    const Triangle& largest = *std::max_element(fills[i].begin(), fills[i].end(),
                                                [&](const auto& s, const auto& t) { return area(s) < area(t); });
    const Vec3 p = (vertices[largest[0]] + vertices[largest[1]] + vertices[largest[2]]) / 3;
    double seen = 0;
    for (const auto& other : fills)
      for (const Triangle& t : other)
        if (&t != &largest) seen += share_of_view(vertices[t[0]], vertices[t[1]], vertices[t[2]], p);
    half_way[i] = std::abs(seen) < max_astray;
  }
  return half_way;
}

Mesh holes_filled(const Mesh& mesh, std::size_t& filled) {
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (v >= mesh.vertices.size()) throw InvalidInput("a triangle uses a vertex that does not exist");
  const std::vector<std::vector<Triangle>> fills = hole_fills(mesh);
  const std::vector<char> half_way = lie_half_way(mesh.vertices, fills);
  Mesh result = mesh;
  filled = 0;
  for (std::size_t i = 0; i < fills.size(); ++i) {
    if (!half_way[i]) continue;
    result.triangles.insert(result.triangles.end(), fills[i].begin(), fills[i].end());
    ++filled;
  }
  return result;
}

}  // namespace evenmesh
