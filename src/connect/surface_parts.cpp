#include "connect/surface_parts.h"

#include <algorithm>

#include "connect/brick_union.h"
#include "sample/blocks.h"

namespace evenmesh {

SurfaceParts surface_parts(const SampleSet& samples, Run& run) {
  const std::vector<std::uint32_t> roots =
      part_roots(samples, cube_bricks(samples, run), run, [](std::uint32_t, std::uint32_t) { return true; });
  SurfaceParts parts;
  parts.part.resize(samples.size());
  for (std::uint32_t i = 0; i < roots.size(); ++i) {
    const bool first = roots[i] == i;
    parts.part[i] = first ? static_cast<std::uint32_t>(parts.area.size()) : parts.part[roots[i]];
    if (first) parts.area.push_back(0);
    parts.area[parts.part[i]] += samples.area[i];
  }
  return parts;
}

std::size_t drop_dust(SampleSet& samples, double least_area, Run& run) {
  const SurfaceParts parts = surface_parts(samples, run);
  const auto dropped = static_cast<std::size_t>(
      std::count_if(parts.area.begin(), parts.area.end(), [&](double a) { return a < least_area; }));
  if (dropped == 0) return 0;
  keep_samples(samples, [&](std::uint32_t i) { return parts.area[parts.part[i]] >= least_area; });
  return dropped;
}

}  // namespace evenmesh
