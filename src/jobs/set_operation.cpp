#include "evenmesh/set_operation.h"

#include <iterator>
#include <utility>

#include "evenmesh/error.h"
#include "evenmesh/solid.h"

namespace evenmesh {

Shape combined(SetOperation operation, std::vector<Shape> shapes) {
  if (operation == SetOperation::unite) return unite(std::move(shapes));
  if (operation == SetOperation::intersect) return intersect(std::move(shapes));
  if (shapes.empty()) throw InvalidInput("a difference needs a solid to take from; give one or more");
  Shape first = std::move(shapes.front());
  shapes.erase(shapes.begin());
  return subtract(std::move(first), std::move(shapes));
}

}  // namespace evenmesh
