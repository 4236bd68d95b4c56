#include "connect/surface_parts.h"

#include <algorithm>

#include "connect/brick_cubes.h"
#include "connect/union_find.h"
#include "sample/blocks.h"

namespace evenmesh {

SurfaceParts surface_parts(const SampleSet& samples, Run& run) {
  std::vector<std::uint32_t> parent(samples.size());
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = static_cast<std::uint32_t>(i);
  CubeWalker walker(samples);
  for (const CubeBrick& brick : cube_bricks(samples, run)) {
    run.throw_if_cancelled();
    walker.walk(brick, [&](const std::uint32_t* loop, int n) {
      for (int i = 1; i < n; ++i) unite(parent, loop[0], loop[i]);
    });
  }
  SurfaceParts parts;
  parts.part.resize(samples.size());
  std::vector<std::uint32_t> number(samples.size());
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    const std::uint32_t root = find_root(parent, i);  // the part's first sample
    if (root == i) number[i] = static_cast<std::uint32_t>(parts.area.size()), parts.area.push_back(0);
    parts.part[i] = number[root];
    parts.area[number[root]] += samples.area[i];
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
