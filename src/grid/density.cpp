#include "grid/density.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/blocks.h"

namespace evenmesh {

double weigh_by_density(SampleSet& samples, const Density& density, ExecutionContext& context) {
  struct Sums {
    double wanted = 0, weight = 0, largest = 0;
  };
  std::vector<Sums> of_block(samples.blocks.size());
  parallel_for(context, samples.blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const SampleBlock& block = samples.blocks[b];
      for (std::uint32_t i = block.begin; i < block.end; ++i) {
        const Vec3 p = samples.block_center(block) + Vec3{samples.x[i], samples.y[i], samples.z[i]};
        const double n = density(p);
        if (!(n > 0 && std::isfinite(n)))
          throw InvalidInput(
              fmt::format("the density must be above 0 everywhere on the surface; at {:.4g}, {:.4g}, {:.4g} "
                          "it is {:.4g}",
                          p.x, p.y, p.z, n));
        of_block[b].largest = std::max(of_block[b].largest, n);
        of_block[b].wanted += samples.area[i] * n;
        samples.area[i] = static_cast<float>(samples.area[i] * n * n);
        of_block[b].weight += samples.area[i];
      }
    }
  });
  Sums all;
  for (const Sums& s : of_block) {
    all.wanted += s.wanted;
    all.weight += s.weight;
    all.largest = std::max(all.largest, s.largest);
  }
  const auto scale = static_cast<float>(samples.total_area / all.weight);
  parallel_for(context, samples.size(), 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) samples.area[i] *= scale;
  });
  return all.largest * samples.total_area / all.wanted;
}

}  // namespace evenmesh
