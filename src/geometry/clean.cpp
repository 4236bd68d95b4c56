#include "geometry/clean.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "evenmesh/error.h"
#include "evenmesh/repair.h"
#include "geometry/coincident.h"
#include "geometry/places.h"
#include "geometry/shared_edges.h"
#include "geometry/triangle.h"
#include "geometry/winding_number.h"

namespace evenmesh {
namespace {

/// Without area, up to rounding.
bool is_flat(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({squared_norm(b - a), squared_norm(c - b), squared_norm(a - c)});
  return squared_norm(cross(b - a, c - a)) <= 1e-28 * longest * longest;
}

/// Adds those triangles without area that join others: without them most of their edges would lack a triangle.
void add_joining(std::vector<Triangle>& triangles, const std::vector<Triangle>& flat, MeshDefects& defects) {
  if (flat.empty()) return;
  const std::size_t first = triangles.size();
  std::vector<Triangle> all = triangles;
  all.insert(all.end(), flat.begin(), flat.end());
  std::vector<int> joins(flat.size(), 0);
  for_each_edge(edge_uses(all), [&](std::span<const EdgeUse> edge) {
    for (const EdgeUse& use : edge)
      if (use.triangle >= first) joins[use.triangle - first] += edge.size() % 2 == 0;
  });
  for (std::size_t i = 0; i < flat.size(); ++i)
    if (joins[i] >= 2) triangles.push_back(flat[i]);
  defects.degenerate_triangles += first + flat.size() - triangles.size();
}

/// An edge's two triangles, and whether they run along it in opposite directions, as neighbours that face one way do.
struct Neighbours {
  std::uint32_t a = 0, b = 0;
  bool agree = false;
};

std::vector<Neighbours> neighbours_of(const std::vector<Triangle>& triangles, MeshDefects& defects) {
  std::vector<Neighbours> list;
  for_each_edge(edge_uses(triangles), [&](std::span<const EdgeUse> edge) {
    defects.boundary_edges += edge.size() == 1;
    defects.non_manifold_edges += edge.size() > 2;
    if (edge.size() == 2) list.push_back({edge[0].triangle, edge[1].triangle, edge[0].up != edge[1].up});
  });
  return list;
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

std::vector<std::uint32_t> orient(Mesh& mesh, MeshDefects& defects) {
  defects.boundary_edges = defects.non_manifold_edges = defects.patches = defects.turned_triangles = 0;
  const std::vector<Neighbours> neighbours = neighbours_of(mesh.triangles, defects);
  std::vector<std::vector<std::pair<std::uint32_t, bool>>> around(mesh.triangles.size());
  for (const Neighbours& n : neighbours) {
    around[n.a].push_back({n.b, n.agree});
    around[n.b].push_back({n.a, n.agree});
  }
  std::vector<signed char> turn(mesh.triangles.size(), 0);  // 1: as it is, −1: the other way, within its patch
  std::vector<std::uint32_t> number(mesh.triangles.size());
  std::vector<std::uint32_t> patch;
  for (std::uint32_t first = 0; first < turn.size(); ++first) {
    if (turn[first] != 0) continue;
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
    for (const std::uint32_t t : patch) {
      number[t] = static_cast<std::uint32_t>(defects.patches);
      if ((turn[t] > 0) != (as_it_is >= 0)) {
        std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
        ++defects.turned_triangles;
      }
    }
    ++defects.patches;
  }
  return number;
}

std::vector<char> hidden_patches(const Mesh& mesh, const std::vector<std::uint32_t>& patch,
                                 std::span<const Triangle> solid) {
  constexpr std::size_t most_probes = 16;
  constexpr double inside = 0.5;
  std::vector<std::vector<std::uint32_t>> members;
  for (std::uint32_t t = 0; t < patch.size(); ++t) {
    if (patch[t] >= members.size()) members.resize(patch[t] + 1);
    members[patch[t]].push_back(t);
  }
  std::vector<char> hidden;
  for (const auto& list : members) {
    const std::size_t step = (list.size() + most_probes - 1) / most_probes;
    bool is_hidden = true;
    for (std::size_t i = 0; i < list.size() && is_hidden; i += step) {
      const auto [a, b, c] = corners_of(mesh, list[i]);
      is_hidden = std::abs(winding_number(mesh.vertices, solid, (a + b + c) / 3)) > inside;
    }
    hidden.push_back(is_hidden);
  }
  return hidden;
}

CleanMesh clean(const Mesh& mesh, MeshDefects& defects) {
  defects = {};
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (v >= mesh.vertices.size()) throw InvalidInput("a triangle uses a vertex that does not exist");
  CleanMesh result;
  result.mesh.vertices = mesh.vertices;
  std::vector<Triangle>& triangles = result.mesh.triangles;
  const std::vector<std::uint32_t> place = places_of(mesh.vertices);
  for (std::size_t v = 0; v < place.size(); ++v) defects.welded_vertices += place[v] != v;
  std::vector<Triangle> flat;
  for (const Triangle& t : mesh.triangles) {
    const Triangle welded{place[t[0]], place[t[1]], place[t[2]]};
    const Vec3 &a = mesh.vertices[welded[0]], &b = mesh.vertices[welded[1]], &c = mesh.vertices[welded[2]];
    if (welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0])
      ++defects.degenerate_triangles;
    else
      (is_flat(a, b, c) ? flat : triangles).push_back(welded);
  }
  add_joining(triangles, flat, defects);
  Coincident coincident = take_coincident(triangles);
  defects.repeated_triangles = coincident.repeated;
  defects.wall_triangles = 2 * coincident.walls.size();
  result.walls = std::move(coincident.walls);
  result.patch = orient(result.mesh, defects);
  return result;
}

Mesh cleaned(const Mesh& mesh, MeshDefects& defects) {
  CleanMesh result = clean(mesh, defects);
  Mesh walls{result.mesh.vertices, result.walls};
  MeshDefects of_walls;
  const std::vector<std::uint32_t> patch = orient(walls, of_walls);
  const std::vector<char> hidden = hidden_patches(walls, patch, result.mesh.triangles);
  for (std::size_t t = 0; t < patch.size(); ++t)
    if (!hidden[patch[t]]) {
      result.mesh.triangles.push_back(walls.triangles[t]);
      defects.wall_triangles -= 2;
      ++defects.repeated_triangles;
    }
  pack(result.mesh);
  return std::move(result.mesh);
}

}  // namespace evenmesh
