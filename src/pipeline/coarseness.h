#pragma once
/// Whether a mesh is too coarse for the surface it shows.

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "refine/vertex_constraints.h"

namespace evenmesh {

struct Coarseness {
  double share = 0;   ///< of the edges, [0, 1]: longer than the radius of curvature, those on feature curves left out
  double factor = 1;  ///< how many times as many vertices would leave few of them
};

/// Two triangles of even edges e on a sphere of radius R differ in their normals by e / (√3 R): what turns by more than
/// that of e = R is longer than the radius of curvature. Cost: about 50 ns per triangle.
Coarseness coarseness(const Mesh& mesh, const VertexConstraints& constraints, const ExecutionContext& context);

}  // namespace evenmesh
