#pragma once
/// Whether a mesh has the sharp edges of another.

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

struct CreaseDistance {
  double largest = 0, mean = 0;  ///< model units; infinite when `of` has sharp edges and `to` has none
  double length = 0;             ///< of the sharp edges of `of`
};

/// From points along the edges of `of` whose two triangles turn by more than 40° to the nearest edge of `to` that turns
/// by more than 20°. Edges of one triangle, or of three, are not sharp edges.
/// @param step  distance between these points at most, model units
CreaseDistance crease_distance(const Mesh& of, const Mesh& to, double step, ExecutionContext& context);

/// Mean length of the triangles' edges; those of two triangles count twice.
double mean_edge_length(const Mesh& mesh);

}  // namespace evenmesh
