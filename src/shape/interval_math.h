#pragma once
/// Intervals that enclose both the exact value and what single precision makes of it.

#include "shape/expression_graph.h"

namespace evenmesh {

/// lo ≤ value ≤ hi, unless the value is not a number, which `may_be_nan` allows for.
struct Enclosure {
  double lo = 0, hi = 0;
  bool may_be_nan = false;
};

/// Encloses one operation on enclosed operands, for exact arithmetic as well as for the tape's float arithmetic.
Enclosure apply(const Node& node, const Enclosure& a, const Enclosure& b);

/// [lo, hi] together with the floats that its points round to.
Enclosure enclose(double lo, double hi);

}  // namespace evenmesh
