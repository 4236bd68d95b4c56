#include <algorithm>
#include <numeric>
#include <tuple>

#include "evenmesh/error.h"
#include "evenmesh/repair.h"
#include "geometry/places.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

/// Without area, up to rounding.
bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({squared_norm(b - a), squared_norm(c - b), squared_norm(a - c)});
  return squared_norm(cross(b - a, c - a)) <= 1e-28 * longest * longest;
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

void drop_repeated(std::vector<Triangle>& triangles, MeshDefects& defects) {
  std::vector<std::uint32_t> order(triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Triangle x = sorted(triangles[a]), y = sorted(triangles[b]);
    return x != y ? x < y : a < b;
  });
  std::vector<char> repeated(triangles.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i)
    repeated[order[i]] = sorted(triangles[order[i]]) == sorted(triangles[order[i - 1]]);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (!repeated[t]) triangles[kept++] = triangles[t];
  defects.repeated_triangles = triangles.size() - kept;
  triangles.resize(kept);
}

/// An edge's two triangles, and whether they run along it in opposite directions, as neighbours that face one way do.
struct Neighbours {
  std::uint32_t a = 0, b = 0;
  bool agree = false;
};

std::vector<Neighbours> neighbours_of(const std::vector<Triangle>& triangles, MeshDefects& defects) {
  struct HalfEdge {
    std::uint32_t low, high, triangle;
    bool up;
  };
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = triangles[t][c], b = triangles[t][(c + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& x, const HalfEdge& y) {
    return std::tuple(x.low, x.high, x.triangle) < std::tuple(y.low, y.high, y.triangle);
  });
  std::vector<Neighbours> list;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high) ++end;
    defects.boundary_edges += end - begin == 1;
    defects.non_manifold_edges += end - begin > 2;
    if (end - begin == 2)
      list.push_back({edges[begin].triangle, edges[begin + 1].triangle, edges[begin].up != edges[begin + 1].up});
  }
  return list;
}

/// Turns triangles patch by patch.
void orient(Mesh& mesh, MeshDefects& defects) {
  const std::vector<Neighbours> neighbours = neighbours_of(mesh.triangles, defects);
  std::vector<std::vector<std::pair<std::uint32_t, bool>>> around(mesh.triangles.size());
  for (const Neighbours& n : neighbours) {
    around[n.a].push_back({n.b, n.agree});
    around[n.b].push_back({n.a, n.agree});
  }
  std::vector<signed char> turn(mesh.triangles.size(), 0);  // 1: as it is, −1: the other way, within its patch
  std::vector<std::uint32_t> patch;
  for (std::uint32_t first = 0; first < turn.size(); ++first) {
    if (turn[first] != 0) continue;
    ++defects.patches;
    patch.assign(1, first);
    turn[first] = 1;
    double as_it_is = 0;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const std::uint32_t t = patch[i];
      const auto [a, b, c] = corners_of(mesh, t);
      as_it_is += turn[t] * triangle_area(a, b, c);
      for (const auto& [other, agree] : around[t])
        if (turn[other] == 0) {
          turn[other] = static_cast<signed char>(agree ? turn[t] : -turn[t]);
          patch.push_back(other);
        }
    }
    for (const std::uint32_t t : patch)
      if ((turn[t] > 0) != (as_it_is >= 0)) {
        std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
        ++defects.turned_triangles;
      }
  }
}

/// Leaves out the vertices that no triangle uses.
void pack(Mesh& mesh) {
  std::vector<std::uint32_t> index(mesh.vertices.size(), 0xffffffffu);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) index[v] = 0;
  std::uint32_t next = 0;
  for (std::size_t v = 0; v < index.size(); ++v)
    if (index[v] == 0) {
      mesh.vertices[next] = mesh.vertices[v];
      index[v] = next++;
    }
  mesh.vertices.resize(next);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = index[v];
}

}  // namespace

Mesh cleaned(const Mesh& mesh, MeshDefects& defects) {
  defects = {};
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (v >= mesh.vertices.size()) throw InvalidInput("a triangle uses a vertex that does not exist");
  Mesh result{mesh.vertices, {}};
  const std::vector<std::uint32_t> place = places_of(mesh.vertices);
  for (std::size_t v = 0; v < place.size(); ++v) defects.welded_vertices += place[v] != v;
  for (const Triangle& t : mesh.triangles) {
    const Triangle welded{place[t[0]], place[t[1]], place[t[2]]};
    const Vec3 &a = mesh.vertices[welded[0]], &b = mesh.vertices[welded[1]], &c = mesh.vertices[welded[2]];
    if (is_degenerate(a, b, c))
      ++defects.degenerate_triangles;
    else
      result.triangles.push_back(welded);
  }
  drop_repeated(result.triangles, defects);
  orient(result, defects);
  pack(result);
  return result;
}

}  // namespace evenmesh
