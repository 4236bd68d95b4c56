#pragma once
/// A function in GLSL as a field.

#include <atomic>
#include <memory>
#include <optional>
#include <span>

#include "gl/context.h"
#include "gl/glsl_source.h"
#include "shape/field.h"

namespace evenmesh::gl {

class PointProgram;

struct FieldTraits {
  double scale = 1;                   ///< typical size of the solid, model units
  double level = 0;                   ///< what is subtracted from the function
  std::optional<double> lipschitz{};  ///< see GlslOptions
};

/// Values come from one program in 32-bit floats, gradients from six more values each: central differences with steps
/// of 2^-10 to 2^-11 of the point's largest coordinate, or of `scale` if that is larger. Where f is smooth, of size
/// about `scale`, gradients are good to some 1e-4.
///
/// Values that are not finite are NaN, so outside, except +infinity; they are counted.
/// All evaluations throw UnusableInput if a loop does not end, or the driver does not come back.
class GlslField final : public Field {
 public:
  /// Compiles; cost about 0.1 s.
  /// @throws UnusableInput  what the driver says, at its place in the user's text
  GlslField(std::shared_ptr<Context> context, GlslSource source, const FieldTraits& traits);
  ~GlslField() override;

  void evaluate(const PointBatch& points, std::span<float> values) const override;
  void evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx, std::span<float> dy,
                         std::span<float> dz) const override;
  /// f at the centre ± lipschitz times half the diagonal, and a margin for rounding; nothing without lipschitz, or
  /// where f is not finite.
  Interval evaluate(const Box& box) const override;
  void enclose(std::span<const Box> boxes, std::span<Interval> ranges) const override;
  bool differentiates() const override { return false; }
  bool encloses_surely() const override { return false; }
  /// Slow: a dispatch, some 0.1 ms, for each point.
  double evaluate(const Vec3& point, Vec3* gradient) const override;
  double epsilon() const override { return scale_ / 1024; }
  std::size_t batch_size() const override { return 262'144; }

  /// Counts those moved for gradients, too.
  const std::atomic<std::size_t>* non_finite_counter() const override { return &non_finite_; }

 private:
  void run(const PointBatch& points, std::span<const std::span<float>> values) const;
  void drop_infinite(std::span<float> values) const;

  GlslSource source_;
  std::shared_ptr<Context> context_;
  std::unique_ptr<PointProgram> device_;  ///< touched in jobs only
  double scale_;                          ///< a power of two
  std::optional<double> lipschitz_;
  mutable std::atomic<std::size_t> non_finite_{0};
};

}  // namespace evenmesh::gl
