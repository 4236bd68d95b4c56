#pragma once
/// Triangles that would fill the holes of a mesh.

#include <span>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// For every closed walk of at most 400 boundary edges the triangles of least area that it bounds, facing as their
/// neighbours do. A boundary edge is one of a single triangle.
/// Cost: n³ ns for a hole of n edges.
std::vector<std::vector<Triangle>> hole_fills(const Mesh& mesh);

/// Of every fill whether it lies about half way between inside and outside, by the generalized winding number, with all
/// of them in place. Cost: 30 ns for every fill and triangle of a fill; where these are more than 10^8 pairs, as in
/// soups, none does.
std::vector<char> lie_half_way(const std::vector<Vec3>& vertices, std::span<const std::vector<Triangle>> fills);

}  // namespace evenmesh
