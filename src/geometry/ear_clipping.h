#pragma once
/// Flat polygons with holes, and the triangles that fill them.

#include <cstddef>
#include <optional>
#include <vector>

#include "evenmesh/mesh.h"
#include "geometry/predicates.h"

namespace evenmesh {

using Contour = std::vector<Point2>;

/// Closed contours with the shape to their left: outer ones run counter-clockwise, holes clockwise.
struct Outline {
  std::vector<Contour> contours;

  std::size_t points() const;
};

/// Twice the signed area, positive when counter-clockwise.
double twice_area(const Contour& contour);

inline bool same_place(const Point2& a, const Point2& b) {
  return a.x == b.x && a.y == b.y;
}

/// Whether a point is inside by the number of edges that a ray to the right crosses.
bool encloses(const Contour& contour, const Point2& p);

/// Triangles that fill the outline; corners are counted through all contours, in their order.
///
/// Their border is that of the contours, edge for edge: counter-clockwise triangles without overlap, n − 2 of them for
/// a single contour of n corners. None where contours cross, or where more than `steps` are needed; steps that were
/// taken are subtracted. Cost: O(points²) steps at worst, near-linear for few notches and holes.
std::optional<std::vector<Triangle>> ear_clipped(const Outline& outline, std::size_t& steps);

}  // namespace evenmesh
