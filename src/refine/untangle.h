#pragma once
/// Triangles that run through each other, pulled apart.

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "evenmesh/mesh.h"
#include "refine/vertex_constraints.h"
#include "sample/projector.h"

namespace evenmesh {

/// Pairs of intersecting triangles of a mesh.
using IntersectionFinder = std::function<std::vector<std::pair<std::uint32_t, std::uint32_t>>(const Mesh&)>;

/// Smooths the vertices of intersecting triangles, in growing neighbourhoods, until nothing intersects or nothing
/// helps; then polishes what has become worse by it. Returns the number of pairs that are left. Cost: one search, and
/// one more for every round that was needed (at most 12), and for the polish.
/// @pre  two-manifold
std::size_t untangle(Mesh& mesh, const Projector* projector, const IntersectionFinder& find, ExecutionContext& context,
                     const VertexConstraints& constraints = {});

/// Vertices around intersections go back to where they were, one ring more of them each round, up to eight.
/// @param before  positions of the same vertices, in the same triangles
/// @return the number of pairs that are left
std::size_t undo_intersections(Mesh& mesh, const std::vector<Vec3>& before, const IntersectionFinder& find);

}  // namespace evenmesh
