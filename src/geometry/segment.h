#pragma once
/// Distances from straight segments.

#include <algorithm>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// The point of a segment from a to b that is nearest to another.
struct SegmentPoint {
  Vec3 point;
  double share = 0;             ///< of the way from a to b, 0 to 1
  double squared_distance = 0;  ///< from the other point
};

/// The segment may have no length. Error: some units in the last place of the largest coordinate difference.
inline SegmentPoint closest_point_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a, from = p - a;
  const double squared_length = squared_norm(along);
  const double share = squared_length > 0 ? std::clamp(dot(from, along) / squared_length, 0.0, 1.0) : 0;
  return {a + share * along, share, squared_norm(from - share * along)};
}

}  // namespace evenmesh
