#include "connect/dual_polygons.h"

#include <algorithm>

#include "geometry/half_edges.h"

namespace evenmesh {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;
Pair ordered(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Calls visit(polygon) for every list of labels.
template <typename Visit>
void for_polygons(const std::vector<std::vector<std::uint32_t>>& polygons, std::span<const std::uint32_t> labels,
                  const Visit& visit) {
  std::vector<std::uint32_t> polygon;
  for (const auto& list : polygons)
    for (std::size_t at = 0; at < list.size(); at += list[at] + 1) {
      polygon.clear();
      for (std::uint32_t i = 1; i <= list[at]; ++i) polygon.push_back(labels[list[at + i]]);
      visit(polygon);
    }
}

/// Edges that diagonals must not double: those of all polygons between corners of polygons with four corners and more,
/// and the diagonals drawn so far.
class TakenEdges {
 public:
  TakenEdges(const std::vector<std::vector<std::uint32_t>>& polygons, std::span<const std::uint32_t> labels,
             std::size_t vertices) {
    std::vector<char> concerned(vertices, 0);
    for_polygons(polygons, labels, [&](const std::vector<std::uint32_t>& polygon) {
      if (polygon.size() > 3)
        for (const std::uint32_t v : polygon) concerned[v] = 1;
    });
    for_polygons(polygons, labels, [&](const std::vector<std::uint32_t>& polygon) {
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const std::uint32_t v = polygon[i], w = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        if (v < w && concerned[v] && concerned[w]) sides_.push_back({v, w});  // w < v comes from the polygon across
      }
    });
    std::sort(sides_.begin(), sides_.end());
  }
  bool has(std::uint32_t a, std::uint32_t b) const {
    const Pair edge = ordered(a, b);
    return std::binary_search(sides_.begin(), sides_.end(), edge) ||
           std::binary_search(diagonals_.begin(), diagonals_.end(), edge);
  }
  void add(std::uint32_t a, std::uint32_t b) {
    const Pair edge = ordered(a, b);
    diagonals_.insert(std::lower_bound(diagonals_.begin(), diagonals_.end(), edge), edge);
  }

 private:
  std::vector<Pair> sides_, diagonals_;
};

/// Cuts off the corner with the shortest diagonal that is no edge yet, until a triangle is left.
void cut_ears(std::vector<std::uint32_t>& polygon, std::span<const Vec3> positions, TakenEdges& taken,
              std::vector<Triangle>& triangles) {
  while (polygon.size() > 3) {
    const std::size_t n = polygon.size();
    std::size_t ear = 0;
    double shortest = std::numeric_limits<double>::infinity();
    bool ear_taken = true;
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t before = polygon[(i + n - 1) % n], after = polygon[(i + 1) % n];
      const double length = squared_norm(positions[after] - positions[before]);
      const bool is_taken = taken.has(before, after);
      if (is_taken < ear_taken || (is_taken == ear_taken && length < shortest)) {
        shortest = length;
        ear = i;
        ear_taken = is_taken;
      }
    }
    const std::uint32_t before = polygon[(ear + n - 1) % n], after = polygon[(ear + 1) % n];
    taken.add(before, after);
    triangles.push_back({before, polygon[ear], after});
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({polygon[0], polygon[1], polygon[2]});
}

}  // namespace

DualMesh triangulate_polygons(const std::vector<std::vector<std::uint32_t>>& polygons,
                              std::span<const std::uint32_t> labels, std::span<const Vec3> positions, bool open) {
  DualMesh mesh;
  TakenEdges taken(polygons, labels, positions.size());
  for_polygons(polygons, labels, [&](std::vector<std::uint32_t>& polygon) {
    bool repeated = false;
    for (std::size_t i = 0; i < polygon.size(); ++i)
      for (std::size_t j = i + 1; j < polygon.size(); ++j)
        if (polygon[i] == polygon[j]) {
          repeated = true;
          mesh.defects.push_back({polygon[i], polygon[i]});
        }
    if (!repeated) cut_ears(polygon, positions, taken, mesh.triangles);
  });
  const auto bad = manifold_defects(mesh.triangles, positions.size(), open);
  mesh.defects.insert(mesh.defects.end(), bad.begin(), bad.end());
  return mesh;
}

std::size_t remove_two_triangle_spheres(std::vector<Triangle>& triangles, std::size_t vertices) {
  std::vector<std::uint32_t> used(vertices, 0);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) ++used[v];
  // Two triangles at each corner of a closed surface are the two sides of a pillow.
  const std::size_t removed = std::erase_if(
      triangles, [&](const Triangle& t) { return used[t[0]] == 2 && used[t[1]] == 2 && used[t[2]] == 2; });
  return removed / 2;
}

Defects manifold_defects(std::span<const Triangle> triangles, std::size_t vertices, bool open) {
  Defects bad;
  const HalfEdges edges(triangles, vertices);
  for (std::size_t h = 0; h < 3 * triangles.size(); ++h)
    if (edges.opposite(h) == HalfEdges::none)
      bad.push_back(ordered(triangles[h / 3][h % 3], triangles[h / 3][(h % 3 + 1) % 3]));
  if (open) {  // an edge of one triangle is boundary; those that come several times are not
    std::sort(bad.begin(), bad.end());
    Defects repeated;
    for (std::size_t i = 1; i < bad.size(); ++i)
      if (bad[i] == bad[i - 1]) repeated.push_back(bad[i]);
    return repeated;
  }
  if (!bad.empty()) return bad;
  for (std::size_t v = 0; v < vertices; ++v)
    if (edges.umbrellas(v) > 1) bad.push_back({static_cast<std::uint32_t>(v), static_cast<std::uint32_t>(v)});
  return bad;
}

}  // namespace evenmesh
