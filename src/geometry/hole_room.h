#pragma once
/// Whether a hole is a mouth or a leak.

#include <span>

#include "evenmesh/mesh.h"
#include "geometry/embree_scene.h"

namespace evenmesh {

/// How wide the space behind a hole is, across, compared with the hole: about 1 behind the mouth of a pipe, a cup or a
/// bottle, more where a piece of a wall is missing. Measured in the plane half way down to what lies behind, no deeper
/// than the hole is wide.
/// @param scene   of the mesh; coordinates up to rounding to single precision
/// @param fill    the triangles that fill the hole
/// @param outward  1 if what they face is outside, −1 if the mesh is inside out
/// Cost: 33 rays.
double room_behind(const EmbreeScene& scene, const std::vector<Vec3>& vertices, std::span<const Triangle> fill,
                   double outward);

}  // namespace evenmesh
