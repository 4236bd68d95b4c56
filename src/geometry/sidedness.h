#pragma once
/// Whether a triangle mesh is closed, and whether it has two sides.

#include <cstddef>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// Whether every edge belongs to an even number of triangles, up to one case in 2⁶⁴. Cost: about 2 ns per triangle.
bool is_closed(const Mesh& mesh);

/// Triangles of patches that cannot face one way, as a Möbius strip or a Klein bottle; 0: all are orientable. Patches
/// are connected across edges of two triangles.
///
/// Cost: about 3 ns per triangle where all edges are used once in each direction, else some 100 ns.
std::size_t one_sided_triangles(const Mesh& mesh, const ExecutionContext& context);

}  // namespace evenmesh
