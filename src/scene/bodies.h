#pragma once
/// Closed triangle meshes of OpenSCAD's bodies, oriented outward: outlines pulled up or turned, polyhedra.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "evenmesh/mesh.h"
#include "scene/outline.h"

namespace evenmesh {

/// How round shapes are cut into straight pieces: $fn, $fa (degrees), $fs (length).
struct Roundness {
  double fn = 0, fa = 12, fs = 2;

  /// Of a full circle: $fn, at least 3, where it is above 0; else ⌈max(min(360 / $fa, 2πr / $fs), 5)⌉.
  double fragments(double radius) const;
};

/// Turned by −twist and scaled on the way up.
struct LinearExtrusion {
  Vec3 up{0, 0, 1};  ///< z above 0
  bool center = false;
  double twist = 0;  ///< degrees
  Point2 scale{1, 1};
  std::uint64_t slices = 1;
};

/// Turned around the z axis, the outline's y becoming z; it lies on one side of the axis.
struct Revolution {
  double start = 0, angle = 360;  ///< degrees; a full turn has no ends
  std::uint64_t fragments = 3;
};

/// Slices that OpenSCAD 2021.01 makes where none are given: so many that the longest way of a point on the way up is
/// cut into pieces as a circle is.
double slices_of(const LinearExtrusion& how, const Roundness& roundness, const Outline& outline);

/// Triangles that will be made, caps included, at most.
std::uint64_t triangles_of(const Outline& outline, const LinearExtrusion& how);
std::uint64_t triangles_of(const Outline& outline, const Revolution& how);

Mesh extrude(const Outline& outline, const LinearExtrusion& how);
Mesh revolve(const Outline& outline, const Revolution& how);

/// @param faces  corners clockwise seen from outside, as OpenSCAD has them; the other way round for all is turned
Mesh polyhedron(std::vector<Vec3> points, const std::vector<std::vector<std::uint32_t>>& faces);

Outline circle_outline(double radius, std::uint64_t fragments);
Outline rectangle_outline(double width, double depth, bool center);
/// What turns into a ball as OpenSCAD makes it: rings half a step away from the poles.
Outline half_ball_outline(double radius, std::uint64_t fragments);

}  // namespace evenmesh
