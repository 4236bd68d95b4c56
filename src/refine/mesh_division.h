#pragma once
/// A mesh divided among those who change it at the same time.

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "refine/editable_mesh.h"

namespace evenmesh {

/// By vertex the part it lies within, or EditableMesh::none. Parts grow from random vertices, one ring after the other;
/// a vertex lies within one if it is not on the boundary, all its neighbours are reached from the same start, and no
/// triangle around faces away from it by more than 60°. Who changes triangles all of whose corners lie within his part
/// reads nothing that others change. Cost: O(vertices).
std::vector<std::uint32_t> divide_mesh(const EditableMesh& mesh, std::size_t parts, Random& random);

}  // namespace evenmesh
