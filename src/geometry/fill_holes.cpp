// Barequet, Sharir, Filling gaps in the boundary of a polyhedron, Computer Aided Geometric Design 12(2), 1995, §3;
// Jacobson, Kavan, Sorkine-Hornung, Robust inside-outside segmentation using generalized winding numbers, ToG 32(4),
// 2013.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "evenmesh/error.h"
#include "evenmesh/repair.h"
#include "geometry/half_edges.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

constexpr std::size_t longest_loop = 400;       ///< edges; the cost goes with the third power
constexpr std::size_t max_views = 100'000'000;  ///< of a fill's triangles from fills: some seconds
constexpr double max_astray = 0.25;             ///< of the winding number half way between inside and outside

constexpr std::uint32_t none = 0xffffffffu;

/// Closed walks along the boundary, each vertex once, so that a triangle for an edge faces as its neighbour does.
std::vector<std::vector<std::uint32_t>> boundary_loops(const Mesh& mesh) {
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  std::vector<std::uint32_t> next(mesh.vertices.size(), none);
  std::vector<char> leaving(mesh.vertices.size(), 0), coming(mesh.vertices.size(), 0);
  const auto count = [](char& c) { c = static_cast<char>(std::min(c + 1, 2)); };
  for (std::size_t h = 0; h < 3 * mesh.triangles.size(); ++h) {
    if (edges.opposite(h) != HalfEdges::none) continue;
    const Triangle& t = mesh.triangles[h / 3];
    const std::uint32_t from = t[(h + 1) % 3], to = t[h % 3];
    next[from] = to;
    count(leaving[from]);
    count(coming[to]);
  }
  std::vector<std::vector<std::uint32_t>> loops;
  std::vector<char> seen(mesh.vertices.size(), 0);
  for (std::uint32_t first = 0; first < next.size(); ++first) {
    std::vector<std::uint32_t> loop;
    for (std::uint32_t v = first; v != none && !seen[v] && leaving[v] == 1 && coming[v] == 1; v = next[v]) {
      seen[v] = 1;
      loop.push_back(v);
    }
    if (loop.size() >= 3 && loop.size() <= longest_loop && next[loop.back()] == first) loops.push_back(std::move(loop));
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

/// Solid angle of a triangle seen from p, as a share of all directions; positive where p is behind it.
double share_of_view(const Mesh& mesh, const Triangle& t, const Vec3& p) {
  const Vec3 a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p, c = mesh.vertices[t[2]] - p;
  const double la = norm(a), lb = norm(b), lc = norm(c);
  // van Oosterom, Strackee, The solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30, 1983.
  return std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb) /
         (2 * std::numbers::pi);
}

}  // namespace

Mesh holes_filled(const Mesh& mesh, std::size_t& filled) {
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (v >= mesh.vertices.size()) throw InvalidInput("a triangle uses a vertex that does not exist");
  std::vector<std::vector<Triangle>> fills;
  for (const auto& loop : boundary_loops(mesh)) fills.push_back(min_area_fill(mesh, loop));
  std::size_t triangles = 0;
  for (const auto& fill : fills) triangles += fill.size();
  filled = 0;
  if (fills.size() * triangles > max_views) return mesh;
  // With all holes filled the winding number on a fill, between its two sides, is half an odd number. Without, it
  // differs from that by what is seen of the fills.
  const auto is_half_way = [&](const std::vector<Triangle>& fill) {
    const auto area = [&](const Triangle& t) {
      return triangle_area(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    };
    const Triangle& largest =
        *std::max_element(fill.begin(), fill.end(), [&](const auto& s, const auto& t) { return area(s) < area(t); });
    const Vec3 p = (mesh.vertices[largest[0]] + mesh.vertices[largest[1]] + mesh.vertices[largest[2]]) / 3;
    double seen = 0;
    for (const auto& other : fills)
      for (const Triangle& t : other)
        if (&t != &largest) seen += share_of_view(mesh, t, p);
    return std::abs(seen) < max_astray;
  };
  Mesh result = mesh;
  for (const auto& fill : fills)
    if (is_half_way(fill)) {
      result.triangles.insert(result.triangles.end(), fill.begin(), fill.end());
      ++filled;
    }
  return result;
}

}  // namespace evenmesh
