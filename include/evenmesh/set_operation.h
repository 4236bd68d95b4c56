#pragma once
/// Booleans as one operation with a name.

#include <vector>

#include "evenmesh/shape.h"

namespace evenmesh {

/// What two or more solids are combined to. Subtract: all others are taken from the first.
enum class SetOperation { unite, intersect, subtract };

/// unite(), intersect() or subtract() of solid.h.
/// @throws InvalidInput  no shape, or a point cloud
Shape combined(SetOperation operation, std::vector<Shape> shapes);

}  // namespace evenmesh
