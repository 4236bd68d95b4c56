#pragma once
/// The final step onto the surface itself.

#include <memory>
#include <span>

#include "evenmesh/execution_context.h"
#include "evenmesh/shape.h"
#include "grid/sample_set.h"

namespace evenmesh {

class Field;

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
std::unique_ptr<Projector> make_projector(const Shape& shape, const Box& bounds, ExecutionContext& context);

/// Two Newton steps of all points at once towards f = 0, for fields of which single points are dear. A point stays
/// where the way is longer than `limit` (model units), comes within `limit` of a face of the bounds, or does not halve
/// |f|. Cost: four calls of the field, with 16 values for each point in all.
void step_onto(std::span<Vec3> points, const Field& field, const Box& bounds, double limit);

/// Onto the plane of the nearest sample: within κ d²/2 of the surface, d the distance between samples, κ the curvature.
/// Keeps a reference to the samples. Cost: about a microsecond per point.
std::unique_ptr<Projector> make_projector(const SampleSet& samples);

}  // namespace evenmesh
