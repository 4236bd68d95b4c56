#include "evenmesh/mesh_shape.h"

#include <cmath>

#include "geometry/primitives.h"
#include "pipeline/draft.h"
#include "pipeline/faults.h"
#include "pipeline/judge.h"
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
  if (!(o.evenness >= 0 && o.evenness <= 1)) throw InvalidInput("the evenness must lie in [0, 1]");
  if (o.bounds && !(is_finite(o.bounds->lo) && is_finite(o.bounds->hi)) && !o.bounds->empty())
    throw InvalidInput("the bounds are not finite: give six numbers");
  if (o.bounds && o.bounds->empty())
    throw InvalidInput("the bounds are empty: each lower limit must be below its upper one");
}

/// First of all what became of the input, and places for what is wrong with triangles.
void complete_findings(const Judgement& judgement, MeshResult& result, ExecutionContext& context) {
  std::vector<Finding>& findings = result.report.findings;
  for (Finding& finding : findings)
    if (const auto place = place_of_fault(result.mesh, finding.code, context))
      finding = make_finding(finding.code, {finding.values[0], {"where", where(*place)}}, place);
  const std::vector<Finding> first = judgement.findings(result.report.quality.edge_length_avg);
  findings.insert(findings.begin(), first.begin(), first.end());
}

/// What the options say of places, counted from the origin. The bounds are with the sampler.
MeshOptions counted_from(const Vec3& origin, MeshOptions options) {
  if (options.density && origin != Vec3{})
    options.density = [density = options.density, origin](const Vec3& p) { return density(p + origin); };
  return options;
}

/// What was found and kept is told in the caller's coordinates.
void move_back(const Vec3& origin, Report& report, Artifacts& kept) {
  for (Finding& finding : report.findings)
    if (finding.place) finding = make_finding(finding.code, std::move(finding.values), *finding.place + origin);
  if (kept.dexels) kept.dexels->origin += origin;
  if (kept.shell) kept.shell->origin += origin;
  if (kept.shell_cut) kept.shell_cut->origin += origin;
}

MeshResult run(const Kernels& kernels, const Shape& shape, const MeshOptions& options, ExecutionContext& context,
               Artifacts& kept) {
  StageTimer timer(context);
  Judgement judgement;
  const Shape solid = timer.stage("sample", 0, [&] { return judged(shape, options, judgement, context); });
  if (options.method != Method::raster) require_insides(solid, context);
  const std::unique_ptr<Sampler> sampler = make_sampler(solid, options.bounds, kernels, timer, context);
  const MeshOptions local = counted_from(sampler->origin(), options);
  Plan plan = make_plan(*sampler, local, timer, context);
  Sampling sampling = sample(*sampler, std::move(plan), local, timer, context, kept);
  const Tessellation cells = tessellate(std::move(sampling), local, kernels, timer, context);
  const Draft draft = timer.stage("place", 0.05, [&] { return extract(cells, local, context); });
  Refined refined = refine(draft, cells, *sampler, local, timer, context);
  LostParts lost = timer.stage("measure", 0, [&] {
    return find_lost_parts(*sampler, cells.sampling, translated(refined.mesh, -sampler->origin()), local, context);
  });
  MeshResult result = measure(std::move(refined), draft, cells, std::move(lost), local, timer, context);
  if (sampler->origin() != Vec3{}) move_back(sampler->origin(), result.report, kept);
  complete_findings(judgement, result, context);
  return result;
}

}  // namespace

MeshResult mesh_with(const Kernels& kernels, const Shape& shape, const MeshOptions& options, ExecutionContext& context,
                     Artifacts& kept) {
  check(options);
  MeshResult result = with_threads(context, [&] { return run(kernels, shape, options, context, kept); });
  result.mesh.unit = shape.unit;
  std::vector<Finding>& findings = result.report.findings;
  findings.insert(findings.begin(), shape.findings.begin(), shape.findings.end());
  return result;
}

MeshResult mesh_shape(const Shape& shape, const MeshOptions& options, ExecutionContext& context, Artifacts* kept) {
  Artifacts none;
  return mesh_with({}, shape, options, context, kept ? *kept : none);
}

}  // namespace evenmesh
