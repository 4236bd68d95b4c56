#pragma once
/// From the cells' triangles to the mesh: onto the surface, well shaped, without self-intersections.

#include "pipeline/draft.h"
#include "pipeline/sampler.h"

namespace evenmesh {

struct Refined {
  Mesh mesh;                           ///< in the caller's coordinates
  std::size_t self_intersections = 0;  ///< pairs of triangles that are left, in the precision that files hold
};

/// Vertices go onto the surface, edges are flipped to Delaunay, the worst triangles polished, apexes and ridges fitted,
/// and what runs through itself is pulled apart. Vertices on feature curves stay on them as long as triangles allow it.
/// A mesh that is not two-manifold is only projected.
/// Guarantee: same bytes for any number of threads.
Refined refine(Draft draft, const Tessellation& cells, const Sampler& sampler, const MeshOptions& options,
               StageTimer& timer, ExecutionContext& context);

}  // namespace evenmesh
