#include "shape/non_finite.h"

#include <algorithm>

#include "evenmesh/solid.h"
#include "shape/field.h"

namespace evenmesh {

NonFiniteValues::NonFiniteValues(Shape shape) : shape_(std::move(shape)) {
  add(shape_);
}

void NonFiniteValues::add(const Shape& shape) {
  if (const Field* field = shape.field()) {
    const std::atomic<std::size_t>* counter = field->non_finite_counter();
    const bool known = std::any_of(before_.begin(), before_.end(), [&](const auto& b) { return b.first == counter; });
    if (counter && !known) before_.emplace_back(counter, counter->load());
  }
  if (const Compound* compound = shape.compound())
    for (const Shape& operand : compound->operands) add(operand);
}

std::size_t NonFiniteValues::count() const {
  std::size_t sum = 0;
  for (const auto& [counter, before] : before_) sum += counter->load() - before;
  return sum;
}

}  // namespace evenmesh
