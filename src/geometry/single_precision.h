#pragma once
/// Whether coordinates in single precision are near enough.

#include "evenmesh/mesh.h"

namespace evenmesh {

/// How far single precision may move a vertex, in edge lengths.
inline constexpr double single_precision_error = 1e-4;

/// How far vertices were moved, in edge lengths: of each triangle the corner moved farthest, over its longest edge; the
/// most of all triangles with an extent. Infinite where one is not finite any more.
/// @param moved  as many vertices
double displacement(const Mesh& mesh, const std::vector<Vec3>& moved);

/// The vertices in single precision.
std::vector<Vec3> in_single_precision(const std::vector<Vec3>& vertices);

/// Whether single precision moves no vertex by more than `single_precision_error` edges. Triangles without an extent do
/// not count. Cost: some nanoseconds per triangle.
bool fits_single_precision(const Mesh& mesh);

}  // namespace evenmesh
