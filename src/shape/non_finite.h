#pragma once
/// Values of a shape's functions that are not finite numbers, counted over one computation.

#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

#include "evenmesh/shape.h"

namespace evenmesh {

/// Counts from when it is made. Fields count for ever (Field::non_finite_counter()), so that evaluating one stays free
/// of state: what a computation adds is the difference.
///
/// A counter that several operands share is counted once. Two computations on one shape at the same time see each
/// other's values. Cost: O(operands).
class NonFiniteValues {
 public:
  /// @param shape  kept alive
  explicit NonFiniteValues(Shape shape);
  /// Values of the shape, or of the operands of a compound, that were not finite since then.
  std::size_t count() const;

 private:
  void add(const Shape& shape);

  Shape shape_;
  std::vector<std::pair<const std::atomic<std::size_t>*, std::size_t>> before_;
};

}  // namespace evenmesh
