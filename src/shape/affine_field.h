#pragma once
/// A field in another place.

#include <functional>
#include <memory>

#include "evenmesh/solid.h"
#include "shape/field.h"

namespace evenmesh {

/// f ∘ transform⁻¹: the solid f < 0 after the transform. Cost: f's, and some nanoseconds per point.
std::shared_ptr<const Field> transformed_field(std::shared_ptr<const Field> field, const Affine& transform);

/// The solid f < 0 within a box, that is closed by its faces.
std::shared_ptr<const Field> boxed_field(std::shared_ptr<const Field> field, const Box& box);

/// f(p + by), as precise as f can be within a box: motions around f become one, and where the points that f is asked at
/// lie far from its origin nevertheless, it is asked in double precision if it knows that. Cost: then some nanoseconds
/// per point and operation.
/// @param where  box of the points p
std::shared_ptr<const Field> shifted_field(std::shared_ptr<const Field> field, const Vec3& by, const Box& where);
/// How far points within the box may lie from where f takes them to be, in its units: 0 where it is asked near its
/// origin, or in double precision.
double rounding_of(const Field& field, const Box& where);

/// What takes the place of a field.
using Replacement = std::function<std::shared_ptr<const Field>(const std::shared_ptr<const Field>&)>;

/// The same motions and boxes around what stands for the field within them; the field itself, if that is the same.
/// @param replace  gets the innermost field, which is the field itself where nothing is around it
std::shared_ptr<const Field> with_innermost(const std::shared_ptr<const Field>& field, const Replacement& replace);

/// The smallest box around a box after the transform; an empty one stays empty.
Box transformed_box(const Box& box, const Affine& transform);

}  // namespace evenmesh
