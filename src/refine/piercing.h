#pragma once
/// Triangles that pierce others nearby.

#include <cstdint>
#include <span>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Whether an edge of one of those triangles pierces another triangle of the mesh, or is the other way round; vertices
/// in common do not count. Exact. Cost: O(those × all), some nanoseconds each: for small meshes.
bool any_pierces(const Mesh& mesh, std::span<const std::uint32_t> triangles);

}  // namespace evenmesh
