#pragma once
/// Points along a feature curve.

#include <cstddef>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

struct PolylinePoint {
  Vec3 place;
  double relative_sizing;  ///< FeatureNode
};

/// Points without those that are nearer than `step` to the one before, or to the last one; first and last stay.
std::vector<PolylinePoint> thinned(const std::vector<PolylinePoint>& points, double step);

double length_of(const std::vector<PolylinePoint>& points);

/// A curve as points with lengths, open or closed.
class Polyline {
 public:
  Polyline(std::vector<PolylinePoint> points, bool closed);

  double length() const { return up_to_.back(); }
  /// The place at a length along it; around a closed one it goes on.
  Vec3 at(double s) const;
  /// Angle by which the direction changes around a point, between chords of length `reach`, or what is there.
  double turn(std::size_t i, double reach) const;
  /// Indices of points where the direction changes by more than `angle` degrees within `reach`, ascending.
  std::vector<std::size_t> turns(double angle, double reach) const;
  /// Where the straight continuations of both sides come nearest to each other; the point itself if that is far.
  Vec3 corner(std::size_t i, double reach, double most) const;

 private:
  std::vector<PolylinePoint> points_;
  bool closed_;
  std::vector<double> up_to_;
};

}  // namespace evenmesh
