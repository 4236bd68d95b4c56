#pragma once
/// Triangles as equilateral as their connectivity allows.

#include <cstddef>
#include <span>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "geometry/quadric.h"
#include "grid/sizing_field.h"
#include "refine/vertex_constraints.h"
#include "sample/projector.h"

namespace evenmesh {

/// The planes that a vertex' samples lie in.
struct CellPlanes {
  Vec3 origin;
  Quadric quadric;  ///< about the origin, weights are areas
};

struct ShapeSmoothingOptions {
  double size_weight = 0.1;              ///< μ, at least 0: what equal sizes count against equal angles
  std::size_t evaluations = 20;          ///< of the energy, about
  std::span<const CellPlanes> planes{};  ///< by vertex; none: nothing holds vertices to ridges and tips
};

struct ShapeSmoothingResult {
  double energy_before = 0, energy = 0;  ///< mean of the triangles'
  std::size_t evaluations = 0;
};

/// μ for an evenness in [0, 1]: from 0.02 over 0.1 to 0.5.
double size_weight_of(double evenness);

/// Moves vertices along the surface to a (local) minimum of
///
///   Σ [(l₁² + l₂² + l₃²) / (4√3·A) − 1] + μ/2 · ln²(A / A₀)  +  λ · Σ (mean squared distance from the planes) / edge²
///
/// over the triangles, and over the vertices and the tangent planes of their cells. The first term, the conformal
/// energy of the map from an equilateral triangle, is 0 for those alone and does not know size; A₀ is the mean area, or
/// what the sizing field wants there. Centroidal Voronoi tessellation pays for a size that is off with four times what
/// a shape that is off by as much costs it, and so spends shape on equal sizes; here the weight is a choice
/// (docs/quality.md). The last sum is flat where the surface is; it keeps vertices on ridges and tips that edges of
/// this length can hardly follow.
///
/// Vertices on feature curves slide along them, corners and vertices on the boundary stay. L-BFGS over two tangential
/// coordinates per vertex; every tenth step, and after the last, vertices are brought onto the surface.
/// @param projector  null: vertices stay in the tangent planes
/// Guarantee: no triangle turns by more than 60° between two of these; none with a score (VertexRings::score) below 0.7
/// is worse than before, but where eight rounds of taking moves back do not end; same bits for any number of threads.
/// Cost: about 0.1 µs per triangle and evaluation, two projections per vertex and ten evaluations.
ShapeSmoothingResult smooth_shapes(Mesh& mesh, const Projector* projector, const SizingField& sizing,
                                   const ShapeSmoothingOptions& options, ExecutionContext& context,
                                   const VertexConstraints& constraints = {});

}  // namespace evenmesh
