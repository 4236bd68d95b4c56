#pragma once
/// The final step onto the surface itself.

#include <memory>

#include "evenmesh/run.h"
#include "evenmesh/shape.h"
#include "sample/sample_set.h"

namespace evenmesh {

/// Brings points that are near a surface onto it. Thread-safe.
class Projector {
 public:
  virtual ~Projector() = default;
  /// The surface point near p; p itself when there is none within `limit` (model units).
  virtual Vec3 project(const Vec3& p, double limit) const = 0;
};

/// Closest point of a mesh, or f = 0 of a field by Newton steps in double precision, and the faces of `bounds` where
/// they cut the solid; null for indicator functions, which know no distance, and point clouds. Cost: a microsecond or
/// two per point.
std::unique_ptr<Projector> make_projector(const Shape& shape, const Box& bounds, Run& run);

/// Onto the plane of the nearest sample: within κ d²/2 of the surface, d the distance between samples, κ the curvature.
/// Keeps a reference to the samples. Cost: about a microsecond per point.
std::unique_ptr<Projector> make_projector(const SampleSet& samples);

}  // namespace evenmesh
