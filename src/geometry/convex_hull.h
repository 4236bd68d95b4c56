#pragma once
/// Convex hulls, with exact predicates.

#include <span>
#include <vector>

#include "evenmesh/mesh.h"
#include "geometry/predicates.h"

namespace evenmesh {

/// The convex hull of points in space, oriented outward; all points stay vertices, those within unused. No triangles
/// where the points lie in a plane. Exact: no point lies outside, and faces of several triangles are flat.
///
/// Cost: about n log n for points of which few are corners, n² at worst.
/// Based on Barber, Dobkin, Huhdanpaa, The Quickhull algorithm for convex hulls, ACM TOMS 22(4), 1996.
Mesh convex_hull(std::span<const Vec3> points);

/// That of points in the plane, counter-clockwise, without points on its straight edges; fewer than three where they
/// lie on a line. Cost: a sort.
/// Based on Andrew, Another efficient algorithm for convex hulls in two dimensions, IPL 9, 1979.
std::vector<Point2> convex_hull(std::vector<Point2> points);

}  // namespace evenmesh
