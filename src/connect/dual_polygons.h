#pragma once
/// Polygons of labels → triangles, and the places where these are not a two-manifold.

#include <cstdint>
#include <span>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

struct DualMesh {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> defects;  ///< vertices on an edge without exactly two opposite triangles, or with several fans; unsorted
};

/// @param polygons  lists of (count, count samples); a polygon's corners are its samples' labels
DualMesh triangulate_polygons(const std::vector<std::vector<std::uint32_t>>& polygons, std::span<const std::uint32_t> labels,
                              std::span<const Vec3> positions);

/// Vertices that keep triangles from being a closed, oriented two-manifold; empty when they are one.
std::vector<std::uint32_t> manifold_defects(std::span<const Triangle> triangles, std::size_t vertices);

}  // namespace evenmesh
