#pragma once
/// Triangles with the same corners: repetitions, walls between bodies, surfaces with two sides.

#include <cstddef>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

struct Coincident {
  std::size_t repeated = 0;     ///< triangles left out because one with the same corners stays
  std::vector<Triangle> walls;  ///< of those that come in pairs and are both left out, one each
};

/// Leaves one triangle for every three corners, or none: what is left has at every edge as even a number of triangles
/// as can be.
///
/// A pair that the surface goes on from at its rim is one triangle given twice. A pair at whose rim the surface is
/// whole without it is a wall: two bodies share it, or both its sides are shown. Which of the two is decided for all
/// pairs that are joined by edges together. How pairs face does not matter.
/// @param triangles  of welded vertices; order and corners of those that stay do not change
Coincident take_coincident(std::vector<Triangle>& triangles);

}  // namespace evenmesh
