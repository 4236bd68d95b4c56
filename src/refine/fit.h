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

/// Lowers the largest distances between samples and mesh. A cell's sample that lies far from the triangles around its
/// vertex is an apex or ridge between vertices; the vertices nearby are moved towards it, along the surface, as long as
/// their triangles stay good (Q ≥ 0.639, angles ≥ 34.2°). On domes so small that no triangle of this size can follow
/// them, the triangle is lifted half way off the surface, by at most a fifth of an edge: that halves the largest
/// deviation. Each round looks at the cells that are nearly as far off as the worst; places that are near enough, and
/// those that would not lower the largest distance, keep their shape.
///
/// @param sample_error  how far samples may lie off the surface, model units: they are brought onto it first; 0 = exact
/// @param vertex_of_sample  vertex whose cell each sample belongs to, none (0xffffffff) for small components
/// Guarantee: same bits for any number of threads. Cost: about 30 ns per sample, and a millisecond for every place
/// tried. Returns the number of places that came nearer.
std::size_t fit_extremes(Mesh& mesh, const SampleSet& samples, std::span<const std::uint32_t> vertex_of_sample,
                         const Projector* projector, double sample_error, ExecutionContext& context,
                         const VertexConstraints& constraints = {});

}  // namespace evenmesh
