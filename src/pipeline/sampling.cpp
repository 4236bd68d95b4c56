#include "pipeline/sampling.h"

#include "grid/density.h"
#include "sample/dexels.h"

namespace evenmesh {
namespace {

/// Over the surface, by area.
double mean_density(const SampleSet& samples, const Density& density, ExecutionContext& context) {
  std::vector<double> of_block(samples.blocks.size(), 0);
  parallel_for(context, samples.blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const SampleBlock& block = samples.blocks[b];
      const Vec3 center = samples.block_center(block);
      for (std::uint32_t i = block.begin; i < block.end; ++i)
        of_block[b] += samples.area[i] * density(center + Vec3{samples.x[i], samples.y[i], samples.z[i]});
    }
  });
  double sum = 0;
  for (const double s : of_block) sum += s;
  return sum / samples.total_area;
}

}  // namespace

double apply_density(Sampling& sampling, const Density& density, ExecutionContext& context) {
  sampling.sizing = SizingField(0, density, mean_density(sampling.samples, density, context));
  if (sampling.sheet) weigh_by_density(sampling.sheet->on_surface, density, context);
  return weigh_by_density(sampling.samples, density, context);
}

Sampling sample(const Sampler& sampler, Plan plan, const MeshOptions& options, StageTimer& timer,
                ExecutionContext& context, Artifacts& kept) {
  const Route route = plan.route;
  Sampling sampling = route == Route::solid ? sample_solid(sampler, std::move(plan), options, timer, context)
                                            : sample_band(sampler, std::move(plan), options, timer, context, kept);
  const double vertices = static_cast<double>(sampling.plan.vertices);
  sampling.sizing = sampling.sizing.with_mean(edge_length_of(sampling.samples.total_area, vertices));
  sampling.sampled = sampling.samples.size();
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
