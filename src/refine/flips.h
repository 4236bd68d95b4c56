#pragma once
/// Edge flips on closed two-manifold meshes.

#include <cstddef>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "refine/vertex_constraints.h"

namespace evenmesh {

/// Flips edges until every one is Delaunay (the angles opposite to it add up to at most 180°), where that neither folds
/// the surface (the two new normals stay within 60° of both old ones) nor doubles an edge. Edges fixed stay.
///
/// Guarantee: stays a closed two-manifold with the same vertices; same bits for any number of threads. Returns the
/// number of flips. Cost: O(triangles), about 0.2 µs each and core, and a microsecond for every flip, one after the
/// other.
/// @pre  closed, oriented, two-manifold
std::size_t flip_to_delaunay(Mesh& mesh, const VertexConstraints& constraints = {},
                             const ExecutionContext& context = ExecutionContext::silent());

}  // namespace evenmesh
