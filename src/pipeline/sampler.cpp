#include "pipeline/sampler.h"

#include <fmt/format.h>

#include <algorithm>

#include "band/moving_least_squares.h"
#include "evenmesh/error.h"
#include "evenmesh/points.h"
#include "evenmesh/repair.h"
#include "evenmesh/solid.h"
#include "geometry/triangle.h"
#include "pipeline/presample.h"
#include "sample/sample.h"
#include "shape/bounds.h"
#include "shape/field.h"
#include "shape/ray_source.h"

namespace evenmesh {
namespace {

/// Single precision holds areas and energies, products of up to four lengths, of models between these sizes.
constexpr double smallest_model = 1e-8, largest_model = 1e10;

/// Voxels of margin that the shell, and what erodes or bridges it, need around the bounds.
unsigned margin_of(const VoxelPlan& plan) {
  return std::max(plan.thickness, plan.bridge) + plan.thickness + 2;
}

/// Up to the rounding of single precision.
bool on_a_line(const std::vector<Vec3>& points) {
  Vec3 along;
  for (const Vec3& p : points)
    if (squared_norm(p - points[0]) > squared_norm(along)) along = p - points[0];
  const double length = norm(along);
  return std::all_of(points.begin(), points.end(),
                     [&](const Vec3& p) { return norm(cross(p - points[0], along)) <= 1e-6 * length * length; });
}

class MeshSampler final : public Sampler {
 public:
  using Sampler::Sampler;
  Solidity solidity(ExecutionContext& context) const override { return measure_solidity(mesh(), context); }
  double area(ExecutionContext&) const override {
    double area = 0;
    for (std::size_t t = 0; t < mesh().triangles.size(); ++t) {
      const auto [a, b, c] = corners_of(mesh(), t);
      area += triangle_area(a, b, c);
    }
    return area;
  }
  SiteVoxels voxelize(const VoxelPlan& plan, ExecutionContext& context) const override {
    return voxelize_mesh(mesh(), make_voxel_grid(bounds(), plan.resolution, margin_of(plan)), context);
  }

 private:
  const Mesh& mesh() const { return *shape_.mesh(); }
};

/// A field's points are projected one by one, or all at once where single ones are expensive.
class FieldSampler final : public Sampler {
 public:
  using Sampler::Sampler;
  double area(ExecutionContext& context) const override { return presample(*this, 0, context).area; }
  SiteVoxels voxelize(const VoxelPlan& plan, ExecutionContext& context) const override {
    return voxelize_field(field(), make_voxel_grid(bounds(), plan.resolution, margin_of(plan)), bounds(), context);
  }
  std::unique_ptr<Projector> projector(const SampleSet& samples, ExecutionContext& context) const override {
    return expensive() ? make_projector(samples) : Sampler::projector(samples, context);
  }
  void step_onto(std::span<Vec3> points, double limit) const override {
    if (expensive()) evenmesh::step_onto(points, field(), bounds(), limit);
  }

 private:
  const Field& field() const { return *shape_.field(); }
  bool expensive() const { return prefers_batches(field()) && field().has_gradient(); }
};

class PointSampler final : public Sampler {
 public:
  PointSampler(Shape shape, const Vec3& origin, const Kernels& kernels, ExecutionContext& context)
      : Sampler(std::move(shape), origin, kernels), spacing_(evenmesh::point_spacing(cloud(), context)) {}

  bool has_inside() const override { return false; }
  Solidity solidity(ExecutionContext&) const override { return {}; }
  double area(ExecutionContext&) const override {
    if (on_a_line(cloud().points)) return 0;
    return 0.75 * static_cast<double>(cloud().points.size()) * spacing_ * spacing_;
  }
  std::optional<double> point_spacing() const override { return spacing_; }
  SiteVoxels voxelize(const VoxelPlan& plan, ExecutionContext& context) const override {
    const VoxelGrid grid = make_voxel_grid(bounds(), plan.resolution, margin_of(plan));
    SiteVoxels sparse = voxelize_points(cloud().points, cloud().normals, grid, context);
    if (sparse.size() == 0) return sparse;
    if (sparse.normal.empty()) estimate_normals(sparse, 2 * plan.bridge, context);
    const NarrowBand band = narrow_band(sparse, plan.bridge, context);
    return moving_least_squares(sparse, band, spacing_, !cloud().normals.empty(), context);
  }

 private:
  const PointCloud& cloud() const { return *shape_.points(); }
  double spacing_;
};

/// Solids made of others: single points of them cannot be asked.
class CompoundSampler final : public Sampler {
 public:
  using Sampler::Sampler;
  double area(ExecutionContext& context) const override { return presample(*this, 0, context).area; }
  SiteVoxels voxelize(const VoxelPlan& plan, ExecutionContext& context) const override {
    return voxelize_samples(sample(make_grid(bounds(), plan.resolution), context), margin_of(plan), context);
  }
  std::unique_ptr<Projector> projector(const SampleSet& samples, ExecutionContext&) const override {
    return make_projector(samples);
  }
};

class RaySampler final : public Sampler {
 public:
  using Sampler::Sampler;
  Solidity solidity(ExecutionContext& context) const override {
    return {.share = source().solidity(bounds(), context), .thickness = {}};
  }
  double area(ExecutionContext& context) const override {
    constexpr std::size_t coarse = 128;
    return source().sample_surface(make_grid(bounds(), coarse), bounds(), context).total_area;
  }
  SiteVoxels voxelize(const VoxelPlan& plan, ExecutionContext& context) const override {
    const SampleSet samples = source().sample_surface(make_grid(bounds(), plan.resolution), bounds(), context);
    return voxelize_samples(samples, margin_of(plan), context);
  }
  std::unique_ptr<Projector> projector(const SampleSet& samples, ExecutionContext&) const override {
    return make_projector(samples);
  }

 private:
  const RaySource& source() const { return *shape_.ray_source(); }
};

bool contains(const Box& outer, const Box& inner) {
  return outer.contains(inner.lo) && outer.contains(inner.hi);
}

/// Booleans leave less than their operands' boxes.
Box tight_bounds(const Shape& compound, ExecutionContext& context) {
  constexpr std::size_t coarse = 96;
  const SampleSet samples = sample_shape(compound, make_grid(compound.bounds, coarse), context);
  Box box;
  for (const SampleBlock& block : samples.blocks)
    for (std::uint32_t s = block.begin; s < block.end; ++s)
      box.add(samples.block_center(block) + Vec3{samples.x[s], samples.y[s], samples.z[s]});
  for (const ThinSpot& spot : samples.thin) box.add(spot.place);
  const double h = 1.5 * samples.grid.spacing;
  return common(compound.bounds, Box{box.lo - Vec3{h, h, h}, box.hi + Vec3{h, h, h}});
}

Shape bounded(Shape shape, const std::optional<Box>& bounds, StageTimer& timer) {
  if (bounds && shape.compound()) {
    shape = intersect({shape, shape_from_box(*bounds)});
  } else if (bounds) {
    const bool whole = shape.mesh() && contains(*bounds, shape.bounds);
    if (!whole) shape.bounds = *bounds;
  } else if (shape.bounds.empty()) {
    shape.bounds = timer.stage("sample", 0, [&] { return find_bounds(shape); });
  }
  return shape;
}

void require_sensible_size(const Shape& shape) {
  const double longest = shape.bounds.longest_side();
  if (longest > 0 && !(longest >= smallest_model && longest <= largest_model))
    throw UnusableInput(fmt::format("the longest side measures {:.3g}: scale it to lie between {:g} and {:g}", longest,
                                    smallest_model, largest_model));
}

}  // namespace

SampleSet Sampler::sample(const Grid& grid, ExecutionContext& context) const {
  return kernels_.rays ? kernels_.rays->sample(shape_, grid, context) : sample_shape(shape_, grid, context);
}

NarrowBand Sampler::narrow_band(const SiteVoxels& sites, unsigned reach, ExecutionContext& context) const {
  return kernels_.band ? kernels_.band->build(sites, reach, context) : build_narrow_band(sites, reach, context);
}

std::unique_ptr<Projector> Sampler::projector(const SampleSet&, ExecutionContext& context) const {
  return make_projector(shape_, bounds(), context);
}

std::unique_ptr<Sampler> make_sampler(const Shape& shape, const std::optional<Box>& bounds, const Kernels& kernels,
                                      StageTimer& timer, ExecutionContext& context) {
  Shape whole = bounded(shape, bounds, timer);
  const Vec3 origin = local_origin(whole.bounds);
  if (origin != Vec3{}) whole = counted_from(origin, whole);
  if (whole.compound()) whole.bounds = timer.stage("sample", 0.02, [&] { return tight_bounds(whole, context); });
  require_sensible_size(whole);
  if (whole.mesh()) return std::make_unique<MeshSampler>(std::move(whole), origin, kernels);
  if (whole.points())
    return timer.stage("voxelize", 0,
                       [&] { return std::make_unique<PointSampler>(std::move(whole), origin, kernels, context); });
  if (whole.compound()) return std::make_unique<CompoundSampler>(std::move(whole), origin, kernels);
  if (whole.ray_source()) return std::make_unique<RaySampler>(std::move(whole), origin, kernels);
  return std::make_unique<FieldSampler>(std::move(whole), origin, kernels);
}

}  // namespace evenmesh
