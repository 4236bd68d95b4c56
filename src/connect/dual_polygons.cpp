#include "connect/dual_polygons.h"

#include <algorithm>

#include "geometry/half_edges.h"

namespace evenmesh {
namespace {

/// Cuts off the corner with the shortest diagonal until a triangle is left.
void cut_ears(std::vector<std::uint32_t>& polygon, std::span<const Vec3> positions, std::vector<Triangle>& triangles) {
  while (polygon.size() > 3) {
    const std::size_t n = polygon.size();
    std::size_t ear = 0;
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const double length = squared_norm(positions[polygon[(i + 1) % n]] - positions[polygon[(i + n - 1) % n]]);
      if (length < shortest) shortest = length, ear = i;
    }
    triangles.push_back({polygon[(ear + n - 1) % n], polygon[ear], polygon[(ear + 1) % n]});
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({polygon[0], polygon[1], polygon[2]});
}

}  // namespace

DualMesh triangulate_polygons(const std::vector<std::vector<std::uint32_t>>& polygons, std::span<const std::uint32_t> labels,
                              std::span<const Vec3> positions) {
  DualMesh mesh;
  std::vector<std::uint32_t> polygon;
  for (const auto& list : polygons)
    for (std::size_t at = 0; at < list.size(); at += list[at] + 1) {
      polygon.clear();
      for (std::uint32_t i = 1; i <= list[at]; ++i) polygon.push_back(labels[list[at + i]]);
      bool repeated = false;
      for (std::size_t i = 0; i < polygon.size(); ++i)
        for (std::size_t j = i + 1; j < polygon.size(); ++j)
          if (polygon[i] == polygon[j]) repeated = true, mesh.defects.push_back({polygon[i], polygon[i]});
      if (!repeated) cut_ears(polygon, positions, mesh.triangles);
    }
  const auto bad = manifold_defects(mesh.triangles, positions.size());
  mesh.defects.insert(mesh.defects.end(), bad.begin(), bad.end());
  return mesh;
}

Defects manifold_defects(std::span<const Triangle> triangles, std::size_t vertices) {
  Defects bad;
  const HalfEdges edges(triangles, vertices);
  for (std::size_t h = 0; h < 3 * triangles.size(); ++h)
    if (edges.opposite(h) == HalfEdges::none) {
      const std::uint32_t v = triangles[h / 3][h % 3], w = triangles[h / 3][(h % 3 + 1) % 3];
      bad.push_back({std::min(v, w), std::max(v, w)});
    }
  if (!bad.empty()) return bad;
  for (std::size_t v = 0; v < vertices; ++v)
    if (edges.fans(v) > 1) bad.push_back({static_cast<std::uint32_t>(v), static_cast<std::uint32_t>(v)});
  return bad;
}

}  // namespace evenmesh
