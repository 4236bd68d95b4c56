#pragma once
/// Vertices at one place.

#include <cstdint>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// For every vertex the lowest one in the same place. Cost: a sort.
std::vector<std::uint32_t> places_of(const std::vector<Vec3>& vertices);

}  // namespace evenmesh
