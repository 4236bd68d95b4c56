#include "pipeline/sampling.h"

#include <cmath>

#include "geometry/sidedness.h"
#include "grid/density.h"
#include "sample/dexels.h"

namespace evenmesh {
namespace {

/// Where the shape itself is not known well enough.
void say_rounding(const Sampler& sampler, Sampling& sampling) {
  constexpr double noticed = 1e-3;  // edges
  const double rounding = sampler.rounding(), edges = rounding / sampling.sizing.mean();
  if (edges > noticed)
    sampling.findings.push_back(make_finding(FindingCode::single_precision,
                                             {{"name", sampler.name()}, {"rounding", rounding}, {"edges", edges}}));
}

}  // namespace

bool Sampling::unresolvable() const {
  double missed = 0;
  for (const ThinSpot& spot : thin) missed += spot.sampled ? 0 : 2 * spot.area;
  return missed > 0.1 * (missed + samples.total_area);
}

double resolution_for(double thickness, const Sampling& sampling) {
  const double cells = static_cast<double>(sampling.plan.grid.resolution);
  return std::ceil(1.01 * cells_across_wall * cells * sampling.samples.grid.spacing / thickness);
}

double apply_density(Sampling& sampling, const Density& density, ExecutionContext& context) {
  if (sampling.sheet) {
    SampleSet& drawn = sampling.sheet->on_surface;
    drawn = weigh_by_density(std::move(drawn), density, context).samples;
  }
  WeightedSamples weighted = weigh_by_density(std::move(sampling.samples), density, context);
  sampling.samples = std::move(weighted.samples);
  sampling.sizing = SizingField(0, density, weighted.mean_density);
  return weighted.max_density / weighted.mean_density;
}

void add_one_sided(const Sampler& sampler, Sampling& sampling, const ExecutionContext& context) {
  const Mesh* mesh = sampler.input_mesh();
  const std::size_t triangles = mesh ? one_sided_triangles(*mesh, context) : 0;
  if (triangles == 0) return;
  const char* solid = "the mesh bounds what rays found enclosed; --method shell follows the surface";
  const char* sheets = "the mesh is cut or leaves parts out where its sides would meet";
  sampling.findings.push_back(make_finding(
      FindingCode::one_sided,
      {{"count", static_cast<double>(triangles)}, {"what", sampling.plan.route == Route::solid ? solid : sheets}}));
}

Sampling sample(const Sampler& sampler, Plan plan, const MeshOptions& options, StageTimer& timer,
                ExecutionContext& context, Artifacts& kept) {
  const Route route = plan.route;
  Sampling sampling = route == Route::solid ? sample_solid(sampler, std::move(plan), options, timer, context)
                                            : sample_band(sampler, std::move(plan), options, timer, context, kept);
  const double vertices = static_cast<double>(sampling.plan.vertices);
  sampling.sizing = sampling.sizing.with_mean(edge_length_of(sampling.samples.total_area, vertices));
  sampling.sampled = sampling.samples.size();
  say_rounding(sampler, sampling);
  if (route == Route::solid) {
    sampling.disagreements = sampling.samples.disagreements;
    sampling.unresolved = sampling.samples.unresolved;
    kept.shell.reset();
    kept.shell_cut.reset();
  }
  if (route == Route::sheets) kept.dexels.reset();
  if (kept.dexels) kept.dexels = dexels_of(sampling.samples);
  return sampling;
}

}  // namespace evenmesh
