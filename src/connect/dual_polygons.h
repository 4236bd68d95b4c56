#pragma once
/// Polygons of labels → triangles, and the places where these are not a two-manifold.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// Edges (a < b) without exactly two opposite triangles; (v, v) for a vertex with several fans, or one that a polygon
/// visits twice. Unsorted, perhaps repeated.
using Defects = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

struct DualMesh {
  std::vector<Triangle> triangles;
  Defects defects;
};

/// In parallel but for polygons with four corners and more; same result for any number of threads.
/// @param polygons  lists of (count, count samples); a polygon's corners are its samples' labels
/// @param open  the surface may have a boundary
DualMesh triangulate_polygons(const std::vector<std::vector<std::uint32_t>>& polygons,
                              std::span<const std::uint32_t> labels, std::span<const Vec3> positions, bool open = false,
                              const ExecutionContext& context = ExecutionContext::silent());

/// Takes out pairs of triangles that share all three corners with each other and none with any other triangle: small
/// components of three cells, closed but flat. Returns how many.
std::size_t remove_two_triangle_spheres(std::vector<Triangle>& triangles, std::size_t vertices);

/// What keeps triangles from being an oriented two-manifold; empty when they are one.
/// @param open  it may have a boundary, also where several fans of triangles meet in a vertex
Defects manifold_defects(std::span<const Triangle> triangles, std::size_t vertices, bool open = false,
                         const ExecutionContext& context = ExecutionContext::silent());

}  // namespace evenmesh
