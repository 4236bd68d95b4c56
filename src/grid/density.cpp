#include "grid/density.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace evenmesh {

WeightedSamples weigh_by_density(SampleSet samples, const Density& density, ExecutionContext& context) {
  struct Sums {
    double wanted = 0, weight = 0, largest = 0;
  };
  const auto sum_up = [&](const auto& of_samples) {  // block by block in order
    std::vector<Sums> of_block(samples.blocks.size());
    parallel_for(context, samples.blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b)
        for (std::uint32_t i = samples.blocks[b].begin; i < samples.blocks[b].end; ++i)
          of_samples(samples.blocks[b], i, of_block[b]);
    });
    Sums all;
    for (const Sums& s : of_block) {
      all.wanted += s.wanted;
      all.weight += s.weight;
      all.largest = std::max(all.largest, s.largest);
    }
    return all;
  };
  samples.weight.resize(samples.size());
  const Sums densities = sum_up([&](const SampleBlock& block, std::uint32_t i, Sums& sums) {
    const Vec3 p = samples.block_center(block) + Vec3{samples.x[i], samples.y[i], samples.z[i]};
    const double given = density(p), n = static_cast<float>(given);
    if (!(n > 0 && std::isfinite(n)))
      throw InvalidInput(
          fmt::format("the density must be above 0 everywhere on the surface; at {:.4g}, {:.4g}, {:.4g} "
                      "it is {:.4g}",
                      p.x, p.y, p.z, given));
    samples.weight[i] = static_cast<float>(n);
    sums.wanted += samples.area[i] * n;
    sums.largest = std::max(sums.largest, n);
  });
  const double mean = densities.wanted / samples.total_area;
  samples.total_weight = sum_up([&](const SampleBlock&, std::uint32_t i, Sums& sums) {
                           const double relative = samples.weight[i] / mean;
                           samples.weight[i] = static_cast<float>(samples.area[i] * relative * relative);
                           sums.weight += samples.weight[i];
                         }).weight;
  return {std::move(samples), mean, densities.largest};
}

}  // namespace evenmesh
