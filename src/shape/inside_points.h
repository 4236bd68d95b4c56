#pragma once
/// Where a field is negative on a grid.

#include <array>
#include <cstddef>
#include <limits>

#include "evenmesh/mesh.h"
#include "shape/field.h"

namespace evenmesh {

struct InsidePoints {
  Box box;                                               ///< of the points at which f < 0
  std::size_t asked = 0, inside = 0, numbers = 0;        ///< points; of these with f < 0, and with any number
  float least = std::numeric_limits<float>::infinity();  ///< f
};

/// Asks at the points of a grid over `box` with so many cells along each side (0: one layer), in batches. Points within
/// `hole`, not on its faces, are left out.
InsidePoints inside_points(const Field& field, const Box& box, const std::array<int, 3>& cells, const Box& hole = {});

}  // namespace evenmesh
