#pragma once
/// Vertices onto apexes and ridges that the mesh cuts off.

#include <cstdint>
#include <span>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "grid/sample_set.h"
#include "refine/vertex_constraints.h"
#include "sample/projector.h"

namespace evenmesh {

struct FitOptions {
  double sample_error = 0;  ///< how far samples may lie off the surface, model units: they are brought onto it first
  double floor = 1;         ///< score (VertexRings::score) that triangles keep; 1: Q ≥ 0.7, angles ≥ 38°
};

struct FitResult {
  std::size_t attempts = 0, moves = 0, flips = 0;  ///< places tried, those that came nearer, and those by a flip
  double deviation_before = 0, deviation = 0;      ///< the largest, model units; 0: below 0.08 edges everywhere
};

/// Lowers the largest distances between the surface and the mesh, either way: samples that lie far from the triangles
/// around the nearest vertex, an apex or ridge between vertices; and triangles that lie far off the surface, across a
/// hollow. A vertex nearby is moved to the place on the surface, and those around it give way along the surface until
/// their triangles are good. Where that is not enough an edge nearby is flipped first; on domes so small that no
/// triangle can follow them, the triangle is lifted half way off the surface, by at most a fifth of an edge.
///
/// Each round looks at the vertices where it is nearly as far as at the worst, as long as they are few: a mesh that is
/// too coarse everywhere has no extremes. Where nothing helps at the worst, those around it are moved. It ends where
/// nothing is farther than 0.17 mean edges (0.08 where hardly anything is above 0.13), or after 260 moves and one for
/// every 420 vertices: each costs the shapes of the triangles around.
/// @param vertex_of_sample  a vertex near each sample, none (0xffffffff) for small components: the nearest one, or what
///                          was nearest before vertices moved by less than an edge
/// @param projector         null: distances from the mesh to the surface do not count
/// Guarantee: no triangle falls below the floor, or below the worst around where that is lower; closed two-manifolds
/// stay so, with the same numbers of vertices and triangles; same bits for any number of threads. Cost: about 30 ns per
/// sample, and half a millisecond for every place tried.
FitResult fit_extremes(Mesh& mesh, const SampleSet& samples, std::span<const std::uint32_t> vertex_of_sample,
                       const Projector* projector, const FitOptions& options, ExecutionContext& context,
                       const VertexConstraints& constraints = {});

}  // namespace evenmesh
