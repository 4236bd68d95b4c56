#pragma once
/// Vertices and edges at which more surfaces meet than a two-manifold can hold, taken apart.

#include <cstdint>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Gives every umbrella of triangles around a vertex a vertex of its own; edges of three triangles and more come apart.
/// Returns the number of new vertices; `source` gets the vertex that each one was copied from. Cost: O(triangles).
std::size_t separate_umbrellas(Mesh& mesh, std::vector<std::uint32_t>& source);

}  // namespace evenmesh
