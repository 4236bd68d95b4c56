#pragma once
/// Where a field's solid is.

#include "evenmesh/mesh.h"
#include "evenmesh/shape.h"
#include "shape/field.h"

namespace evenmesh {

/// Box around the solid f < 0, a few per cent larger than the solid.
///
/// Interval arithmetic proves that f ≥ 0 from the box's sides outward, up to a distance of a million units from the
/// origin; the farthest reaches stand for what lies beyond. The solid must show itself on a grid of 128 points along
/// the box's longest side.
/// Fields that know no intervals, or too wide ones, as of quotients by what passes through zero, are asked at points
/// instead: see probed_bounds().
/// Cost: a few milliseconds for formulas of a few dozen operations; some dozens of calls for fields that want batches.
/// @throws UnusableInput  the solid is unbounded, or f < 0 nowhere
Box find_bounds(const Field& field);

/// The shape's own bounds, or those found for its field or from the parts of a compound, of which some may be
/// unbounded.
/// @throws UnusableInput  nothing bounds it
Box find_bounds(const Shape& shape);

}  // namespace evenmesh
