#pragma once
/// Whether two triangles of a mesh intersect in more than the vertices they share: the narrow phase of
/// self_intersections().

#include <cstdint>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// For each triangle the axis along which its projection is largest and surely not degenerate; 3 for degenerate
/// triangles.
std::vector<std::uint8_t> projection_axes(const Mesh& mesh, const ExecutionContext& context);

/// Whether triangles s and t intersect as self_intersections() counts it. Exact. Both must not be degenerate.
/// @param axis  a projection axis of s
/// Cost: some 20 ns for neighbours and for triangles well apart, a few hundred for others.
bool triangles_overlap(const Mesh& mesh, std::uint32_t s, std::uint32_t t, int axis);

}  // namespace evenmesh
