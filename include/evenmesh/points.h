#pragma once
/// Point clouds: points of a surface, with or without normals.

#include <cstddef>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// Points of a surface in model units, in any order; the same point may occur several times.
struct PointCloud {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;  ///< empty, or one per point: outward, of any length, zero where unknown

  /// Box of all points.
  Box bounds() const;
};

/// Typical distance between neighbours: the median over the points of the distance to the sixth nearest other point.
/// Regular points of a plane have their spacing there, random ones of density ρ about √(6 / (π ρ)). Repeated points
/// count once.
///
/// Returns model units; 0 when fewer than two points differ. From 131,072 points on, the median is over as many, spread
/// evenly. Guarantee: same bits for any number of threads. Cost: O(points · log points), about 0.6 s per million.
/// @throws InvalidInput  a coordinate is not finite
double point_spacing(const PointCloud& cloud, ExecutionContext& context = ExecutionContext::silent());

/// Which points are taken for outliers.
struct OutlierOptions {
  std::size_t neighbours = 12;  ///< nearest other points that a point is measured by, [1, 64]
  double deviations = 3;        ///< standard deviations above the mean that are still allowed, [0, 100]
};

/// The cloud without points that lie far from all others: those whose mean distance to their nearest neighbours exceeds
/// the mean over all points by more than some standard deviations. Order is kept.
///
/// A few points very far away raise the deviation and hide others: call it again until the count stays.
/// Guarantee: same bits for any number of threads. Cost: O(points · neighbours · log points).
/// @throws InvalidInput  options out of range, a coordinate that is not finite, or normals that are not one per point
/// Based on Rusu et al., Towards 3D point cloud based object maps for household environments, RAS 2008.
PointCloud remove_outliers(const PointCloud& cloud, const OutlierOptions& options = {},
                           ExecutionContext& context = ExecutionContext::silent());

}  // namespace evenmesh
