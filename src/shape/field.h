#pragma once
/// Scalar fields: implicit surfaces f = 0, inside where f < 0.

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Closed interval of reals; [-inf, inf] when nothing is known.
struct Interval {
  double lo = 0, hi = 0;
};

/// Points in structure-of-arrays form; all spans have the same length.
struct PointBatch {
  std::span<const float> x, y, z;
};

/// A function of space. Implementations are immutable and may be evaluated from several threads at once.
///
/// NaN counts as outside. Same inputs give the same bits wherever they stand in a batch, for any batch size.
class Field {
 public:
  virtual ~Field() = default;

  /// values[i] = f(point i). Cost: a few nanoseconds per point and operation; best with 256 points or more.
  virtual void evaluate(const PointBatch& points, std::span<float> values) const = 0;

  /// Also the gradient of f. The default differentiates numerically by central differences with the step `epsilon()`.
  virtual void evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx,
                                 std::span<float> dy, std::span<float> dz) const;

  /// Encloses f over a box; the default knows nothing ([-inf, inf]), then nothing is pruned.
  virtual Interval evaluate(const Box& box) const;
  /// Encloses f over each of several boxes. The default asks for one after the other.
  virtual void enclose(std::span<const Box> boxes, std::span<Interval> ranges) const;
  /// Where this field counts its values that were not finite, and so outside; null where it does not count. The count
  /// only grows; fields made of another one share its counter. See NonFiniteValues for those of one computation.
  virtual const std::atomic<std::size_t>* non_finite_counter() const { return nullptr; }
  /// Values that were not finite since the field was made.
  std::size_t non_finite() const {
    const std::atomic<std::size_t>* counter = non_finite_counter();
    return counter ? counter->load() : 0;
  }
  /// False where a gradient is made of seven values; true where it costs little more than one.
  virtual bool differentiates() const { return true; }
  /// False where the enclosures are somebody's word: then the surface is followed to where they deny it.
  virtual bool encloses_surely() const { return true; }
  /// Points per call from which on the cost per point no longer falls. Fields that want many are not asked for single
  /// points.
  virtual std::size_t batch_size() const { return 1024; }

  /// f and its gradient at one point in double precision; gradient may be null. The default rounds through evaluate().
  virtual double evaluate(const Vec3& point, Vec3* gradient) const;

  /// Whether the value at one point really is in double precision.
  virtual bool is_precise() const { return false; }

  /// A cheaper field with the same bits at every point of `box` (branches of min, max and abs decided), or nullptr when
  /// nothing is gained. Cost: one interval evaluation and one compilation, worth it from some thousand points on.
  virtual std::shared_ptr<const Field> specialized(const Box& box) const;

  /// Step for numerical derivatives, model units.
  virtual double epsilon() const { return 1e-4; }
  /// True when f has a usable gradient; false for indicator functions, whose value is only -1 or 1.
  virtual bool has_gradient() const { return true; }
};

/// Whether a call costs as much as many points: then it pays to ask for all that is known to be needed at once.
inline bool prefers_batches(const Field& field) {
  return field.batch_size() > 1024;
}

}  // namespace evenmesh
