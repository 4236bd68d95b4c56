#pragma once
/// A shape as the pipeline sees it: something that can be sampled.

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "band/voxelize.h"
#include "evenmesh/shape.h"
#include "grid/sample_set.h"
#include "pipeline/kernels.h"
#include "pipeline/stage_timer.h"
#include "sample/extra_directions.h"
#include "sample/projector.h"
#include "shape/local_origin.h"
#include "shape/non_finite.h"

namespace evenmesh {

/// How voxels are made. Lengths in voxels.
struct VoxelPlan {
  std::size_t resolution = 0;  ///< along the longest side of the bounds
  unsigned thickness = 0;      ///< half the width of the shell
  unsigned bridge = 0;         ///< of points: half the width of the gaps between them that are closed
};

/// Samples one shape. What differs between kinds of shapes is in here, and nowhere else in the pipeline.
///
/// Callable from one thread at a time; uses several itself.
class Sampler {
 public:
  /// @param shape  counted from the origin
  Sampler(Shape shape, const Vec3& origin, const Kernels& kernels)
      : shape_(std::move(shape)), origin_(origin), kernels_(kernels), non_finite_(shape_) {}
  virtual ~Sampler() = default;
  Sampler(const Sampler&) = delete;
  Sampler& operator=(const Sampler&) = delete;

  /// The triangles of a shape that is a mesh; null for others.
  const Mesh* mesh() const { return shape_.mesh(); }
  const std::string& name() const { return shape_.name; }
  const Box& bounds() const { return shape_.bounds; }
  /// Where the sampler's coordinates, which are all that the pipeline sees, begin in the caller's (local_origin.h).
  const Vec3& origin() const { return origin_; }
  /// How far points may be off, since the shape knows them in single precision only; model units.
  double rounding() const { return rounding_of(shape_, origin_); }
  /// Closing the solid where the bounds cut it is part of the shape's definition.
  bool capped_by_bounds() const { return shape_.capped_by_bounds; }

  /// The input where it is a triangle mesh, else nullptr.
  const Mesh* input_mesh() const { return shape_.mesh(); }

  /// Whether rays can tell inside from outside at all: not for points.
  virtual bool has_inside() const { return true; }
  /// How far there is an inside to speak of: a share of 1 for solids.
  virtual Solidity solidity(ExecutionContext&) const { return {.share = 1, .thickness = {}}; }
  /// Of the surface, in squared model units, estimated coarsely where it must be; 0 where there is none.
  virtual double area(ExecutionContext& context) const = 0;
  /// Mean distance between points, model units; none for surfaces.
  virtual std::optional<double> point_spacing() const { return std::nullopt; }

  /// The crossings of the solid's surface with a grid. @throws UnusableInput  no surface within the bounds
  virtual SampleSet sample(const Grid& grid, ExecutionContext& context) const;
  /// The voxels that the surface touches.
  virtual SiteVoxels voxelize(const VoxelPlan& plan, ExecutionContext& context) const = 0;

  /// The voxels within `reach` voxels of the sites.
  NarrowBand narrow_band(const SiteVoxels& sites, unsigned reach, ExecutionContext& context) const;

  /// Onto the shape itself, or onto `samples` where single points of it are expensive; null where neither is known.
  virtual std::unique_ptr<Projector> projector(const SampleSet& samples, ExecutionContext& context) const;
  /// The last bit of the way for points that were projected onto samples only, all at once.
  /// @param limit  no point moves farther, model units
  virtual void step_onto(std::span<Vec3>, double) const {}

  /// Evaluations that gave no finite number, since the sampler was made.
  std::size_t non_finite() const { return non_finite_.count(); }

 protected:
  Shape shape_;

 private:
  Vec3 origin_;
  Kernels kernels_;
  NonFiniteValues non_finite_;
};

/// Refuses solids made of sheets: booleans and offsets need an inside of every triangle mesh among their operands.
/// @throws UnusableInput  solidity below min_solidity: which one, and what to do
void require_insides(const Shape& shape, ExecutionContext& context);

/// The only place that asks what kind a shape is. Finds bounds where there are none, and cuts the shape by those given.
/// @throws UnusableInput  nothing bounds it, or its longest side is not between 1e-8 and 1e10
/// @param kernels  must outlive it
std::unique_ptr<Sampler> make_sampler(const Shape& shape, const std::optional<Box>& bounds, const Kernels& kernels,
                                      StageTimer& timer, ExecutionContext& context);

}  // namespace evenmesh
