#pragma once
/// Vertices around one that was moved give way to it.

#include <cstdint>
#include <span>

#include "evenmesh/mesh.h"
#include "refine/vertex_rings.h"
#include "sample/projector.h"

namespace evenmesh {

/// Moves the vertices of the list along the surface so that their triangles become good: towards a minimum of
/// Σ max(0, D − 1.08)², where D = (l₁² + l₂² + l₃²) / (4√3·A) is the triangle's conformal energy, 1 when equilateral.
/// What is good enough stays as it is. One vertex after the other, a step of Newton's method each; at most `sweeps`
/// times over the list.
///
/// Guarantee: no triangle turns by more than 70° in one step. Cost: a microsecond or two for every step of a vertex.
void give_way(Mesh& mesh, const VertexRings& rings, const Projector* projector, std::span<const std::uint32_t> vertices,
              int sweeps);

}  // namespace evenmesh
