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

/// What takes the place of a field.
using Replacement = std::function<std::shared_ptr<const Field>(const std::shared_ptr<const Field>&)>;

/// The same motions and boxes around what stands for the field within them; the field itself, if that is the same.
/// @param replace  gets the innermost field, which is the field itself where nothing is around it
std::shared_ptr<const Field> with_innermost(const std::shared_ptr<const Field>& field, const Replacement& replace);

/// The smallest box around a box after the transform; an empty one stays empty.
Box transformed_box(const Box& box, const Affine& transform);

}  // namespace evenmesh
