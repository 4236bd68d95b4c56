#pragma once
/// What cleaned() makes of a mesh, before walls are put back.

#include <cstdint>
#include <span>
#include <vector>

#include "evenmesh/mesh.h"
#include "evenmesh/repair.h"

namespace evenmesh {

/// Turns triangles patch by patch, each the way of most of its area; returns the number of each triangle's patch. A
/// patch is connected across edges of two triangles.
/// @param defects  patches, edges and turned triangles are counted anew
std::vector<std::uint32_t> orient(Mesh& mesh, MeshDefects& defects);

struct CleanMesh {
  Mesh mesh;                         ///< welded, without degenerate and repeated triangles, patches facing one way
  std::vector<std::uint32_t> patch;  ///< of every triangle
  std::vector<Triangle> walls;       ///< that two bodies share, or of which both sides are shown (coincident.h)
};

/// @throws InvalidInput  a triangle's index is out of range
CleanMesh clean(const Mesh& mesh, MeshDefects& defects);

/// Of every patch whether it lies within a solid, by 16 points of it at most.
/// @param solid  triangles of the same vertices
std::vector<char> hidden_patches(const Mesh& mesh, const std::vector<std::uint32_t>& patch,
                                 std::span<const Triangle> solid);

}  // namespace evenmesh
