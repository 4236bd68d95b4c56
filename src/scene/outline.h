#pragma once
/// Flat shapes: closed polygons with holes, and the triangles that fill them.

#include <vector>

#include "evenmesh/mesh.h"
#include "geometry/ear_clipping.h"

namespace evenmesh {

/// The region inside of an odd number of paths, which may cross themselves and each other (see untangled).
///
/// Repeated points are left out, and what has no area. Cost: paths × points, and the pairs of edges side by side.
/// @throws UnusableInput  more than 10⁹ of either, or crossings that cannot be resolved
Outline outline_of_paths(std::vector<Contour> paths);

/// Triangles that fill the outline; corners are counted through all contours, in their order.
///
/// Their border is that of the contours, edge for edge, and they add up to its winding number: counter-clockwise
/// triangles without overlap where no contour crosses one, signed ones that cancel where one does, or where it has very
/// many points. Cost: O(points²) at worst, near-linear for few notches and holes.
std::vector<Triangle> fill(const Outline& outline);

}  // namespace evenmesh
