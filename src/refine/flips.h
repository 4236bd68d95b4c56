#pragma once
/// Edge flips on closed two-manifold meshes.

#include <cstddef>

#include "evenmesh/mesh.h"
#include "refine/vertex_constraints.h"

namespace evenmesh {

/// Flips edges until every one is Delaunay (the angles opposite to it add up to at most 180°), where that neither folds
/// the surface (the two new normals stay within 60° of both old ones) nor doubles an edge. Edges held stay.
///
/// Guarantee: stays a closed two-manifold with the same vertices. Returns the number of flips. Cost: O(triangles).
/// @pre  closed, oriented, two-manifold
std::size_t flip_to_delaunay(Mesh& mesh, const VertexConstraints& constraints = {});

}  // namespace evenmesh
