#pragma once
/// Flat shapes grown and shrunk.

#include <cstdint>

#include "scene/outline.h"

namespace evenmesh {

/// What a corner becomes that is grown outward.
enum class FlatJoin { round, miter, chamfer };

struct FlatOffset {
  double distance = 0;  ///< above 0 grows, below 0 shrinks
  FlatJoin join = FlatJoin::round;
  std::uint64_t fragments = 5;  ///< of a full circle, for round joins
};

/// Everything within the distance of the outline, or what is farther than that from its outside: the union with, or
/// what is left without, a strip along every edge and the joins between them. Cost: that of combined().
/// @throws UnusableInput  as combined()
Outline offset_outline(const Outline& outline, const FlatOffset& how);

}  // namespace evenmesh
