#pragma once
/// Last improvement of the few worst triangles, and of the few worst deviations.

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "refine/vertex_constraints.h"
#include "sample/projector.h"

namespace evenmesh {

/// Moves the vertices of bad triangles (Q below 0.7 or an angle below 38°) along the surface so that the worst one
/// around each of them gets better (pattern search, steps of a fifth to a hundredth of the local edge length), then
/// back onto the surface, or along the feature curve they lie on; never folds a triangle over.
///
/// Guarantee: the worst triangle does not get worse; same bits for any number of threads. Cost: O(bad triangles), plus
/// 30 ns for every triangle. Returns the number of moves.
std::size_t polish(Mesh& mesh, const Projector* projector, ExecutionContext& context,
                   const VertexConstraints& constraints = {});

}  // namespace evenmesh
