#include "evenmesh/mesh_shape.h"

#include <cmath>

#include "pipeline/draft.h"
#include "pipeline/kernels.h"
#include "pipeline/lost_parts.h"
#include "pipeline/plan.h"
#include "pipeline/refine.h"
#include "pipeline/report.h"
#include "pipeline/sampler.h"
#include "pipeline/tessellate.h"

namespace evenmesh {
namespace {

void check(const MeshOptions& o) {
  if (o.vertices && o.edge_length) throw InvalidInput("give a vertex count or an edge length, not both");
  if (o.vertices && (*o.vertices < 4 || *o.vertices > 1'000'000'000))
    throw InvalidInput("the vertex count must lie in [4, 1e9]");
  if (o.edge_length && !(*o.edge_length > 0 && std::isfinite(*o.edge_length)))
    throw InvalidInput("the edge length must be a number above 0");
  if (o.resolution && (*o.resolution < 8 || *o.resolution > max_resolution))
    throw InvalidInput("the resolution must lie in [8, 8192]");
  if (o.thickness && (*o.thickness < 1 || *o.thickness > max_thickness))
    throw InvalidInput("the shell's thickness must lie in [1, 20] voxels");
  if (o.max_cycle < 3 || o.max_cycle > 8) throw InvalidInput("the longest cycle must lie in [3, 8] edges");
  if (o.iterations && *o.iterations > 10'000) throw InvalidInput("the iterations must lie in [0, 10000]");
  if (o.feature_angle && !(*o.feature_angle > 0 && *o.feature_angle < 180))
    throw InvalidInput("the angle of sharp edges must lie in (0, 180) degrees");
  if (!(o.tolerance > 0 && o.tolerance < 1)) throw InvalidInput("the tolerance must lie in (0, 1)");
  if (o.bounds && !(is_finite(o.bounds->lo) && is_finite(o.bounds->hi)) && !o.bounds->empty())
    throw InvalidInput("the bounds are not finite: give six numbers");
  if (o.bounds && o.bounds->empty())
    throw InvalidInput("the bounds are empty: each lower limit must be below its upper one");
}

MeshResult run(const Kernels& kernels, const Shape& shape, const MeshOptions& options, ExecutionContext& context,
               Artifacts& kept) {
  StageTimer timer(context);
  const std::unique_ptr<Sampler> sampler = make_sampler(shape, options.bounds, kernels, timer, context);
  Plan plan = make_plan(*sampler, options, timer, context);
  Sampling sampling = sample(*sampler, std::move(plan), options, timer, context, kept);
  const Tessellation cells = tessellate(std::move(sampling), options, kernels, timer, context);
  const Draft draft = timer.stage("place", 0.05, [&] { return extract(cells, options, context); });
  Refined refined = refine(draft, cells, *sampler, options, timer, context);
  LostParts lost = timer.stage(
      "measure", 0, [&] { return find_lost_parts(*sampler, cells.sampling, refined.mesh, options, context); });
  return measure(std::move(refined), draft, cells, std::move(lost), options, timer, context);
}

}  // namespace

MeshResult mesh_with(const Kernels& kernels, const Shape& shape, const MeshOptions& options, ExecutionContext& context,
                     Artifacts& kept) {
  check(options);
  return with_threads(context, [&] { return run(kernels, shape, options, context, kept); });
}

MeshResult mesh_shape(const Shape& shape, const MeshOptions& options, ExecutionContext& context, Artifacts* kept) {
  Artifacts none;
  return mesh_with({}, shape, options, context, kept ? *kept : none);
}

}  // namespace evenmesh
