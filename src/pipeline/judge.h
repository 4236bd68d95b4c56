#pragma once
/// What of a triangle mesh is a solid, decided before it is sampled.

#include <cstddef>
#include <vector>

#include "evenmesh/findings.h"
#include "evenmesh/mesh_shape.h"
#include "geometry/mesh_parts.h"

namespace evenmesh {

/// What was found in the meshes of a shape, each list largest first.
struct Judgement {
  std::size_t turned_triangles = 0;
  std::vector<MeshPiece> filled_holes, turned_bodies, sheets;

  /// @param edge  of the mesh to be made, model units: what is smaller cannot be seen in it
  std::vector<Finding> findings(double edge) const;
};

/// The shape with every mesh that bounds a solid reduced to what bounds it: small holes filled, inverted parts turned,
/// loose sheets left out (mesh_parts.h). Operands of compounds, too.
///
/// A mesh stays as it is where it is in order, where no part of it is closed, where surfaces are asked for (shell,
/// wrap), and, if the method is left open, where its sheets have more area than what is closed.
Shape judged(const Shape& shape, const MeshOptions& options, Judgement& judgement, ExecutionContext& context);

}  // namespace evenmesh
