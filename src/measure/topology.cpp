#include "measure/topology.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/union_find.h"

namespace evenmesh {
namespace {

/// One of the three sides of a triangle, filed under its lower vertex.
struct Side {
  std::uint32_t upper;
  std::uint32_t face;
  std::uint8_t first;  ///< corner of the face where the side starts
  bool ascending;      ///< runs from the lower vertex to the upper
};

/// All sides in one array: those of lower vertex v at [begin[v], begin[v + 1]), sorted by upper vertex and face.
struct Sides {
  std::vector<std::uint32_t> begin;
  std::vector<Side> sides;
};

Sides collect_sides(const Mesh& mesh) {
  Sides result;
  result.begin.assign(mesh.vertices.size() + 2, 0);
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++result.begin[std::min(t[k], t[(k + 1) % 3]) + 2];
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
  result.sides.resize(3 * mesh.triangles.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[f][k], b = mesh.triangles[f][(k + 1) % 3];
      result.sides[result.begin[std::min(a, b) + 1]++] = {std::max(a, b), f, k, a < b};
    }
  result.begin.pop_back();
  // Faces came in order and a vertex has few sides: insertion sort keeps both cheap; hubs are left to std::sort.
  const auto before = [](const Side& a, const Side& b) {
    return a.upper != b.upper ? a.upper < b.upper : a.face != b.face ? a.face < b.face : a.first < b.first;
  };
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto first = result.sides.begin() + result.begin[v], last = result.sides.begin() + result.begin[v + 1];
    if (last - first > 32) {
      std::sort(first, last, before);
      continue;
    }
    for (auto i = first; i != last; ++i)
      for (auto j = i; j != first && before(*j, *(j - 1)); --j) std::swap(*j, *(j - 1));
  }
  return result;
}

std::uint32_t corner_of(const Mesh& mesh, std::uint32_t face, std::uint32_t vertex) {
  const Triangle& t = mesh.triangles[face];
  return 3 * face + (t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2);
}

std::vector<VertexState> count_corners(const Mesh& mesh) {
  std::vector<VertexState> states(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      VertexState& state = states[t[k]];
      state.used = true;
      // A repeated vertex has one corner in a triangle.
      if (std::find(t.begin(), t.begin() + k, t[k]) == t.begin() + k) ++state.umbrellas;
    }
  return states;
}

/// One edge: the sides [begin, end) that join `lower` and begin->upper.
void add_edge(const Mesh& mesh, std::uint32_t lower, const Side* begin, const Side* end, UnionFind& corners,
              UnionFind& faces, Topology& topology) {
  const std::uint32_t upper = begin->upper;
  const auto count = end - begin;
  VertexState &a = topology.vertices[lower], &b = topology.vertices[upper];
  ++topology.edges;
  ++a.valence;
  ++b.valence;
  const double squared = squared_norm(mesh.vertices[upper] - mesh.vertices[lower]);
  topology.length_sum += std::sqrt(squared);
  topology.length_squares += squared;
  if (count == 1) {
    ++topology.boundary;
    a.on_boundary = b.on_boundary = true;
  }
  if (count > 2) {
    ++topology.non_manifold;
    a.on_non_manifold_edge = b.on_non_manifold_edge = true;
  }
  if (count == 2) {
    if (begin[0].ascending == begin[1].ascending) ++topology.inconsistent;
    for (const std::uint32_t v : {lower, upper})
      if (corners.unite(corner_of(mesh, begin[0].face, v), corner_of(mesh, begin[1].face, v)))
        --topology.vertices[v].umbrellas;
  }
  for (const Side* side = begin + 1; side != end; ++side)
    if (faces.unite(begin->face, side->face)) --topology.components;
}

}  // namespace

Topology measure_topology(const Mesh& mesh) {
  Topology topology;
  topology.vertices = count_corners(mesh);
  topology.components = mesh.triangles.size();
  const Sides all = collect_sides(mesh);
  UnionFind corners(3 * mesh.triangles.size()), faces(mesh.triangles.size());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const Side *side = all.sides.data() + all.begin[v], *last = all.sides.data() + all.begin[v + 1];
    while (side != last) {
      const Side* end = side + 1;
      while (end != last && end->upper == side->upper) ++end;
      add_edge(mesh, v, side, end, corners, faces, topology);
      side = end;
    }
  }
  return topology;
}

}  // namespace evenmesh
