#include "connect/surface_parts.h"

#include <algorithm>

#include "connect/brick_cubes.h"
#include "connect/union_find.h"

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
  std::uint32_t kept = 0;
  std::vector<SampleBlock> blocks;
  const auto keep = [&](auto& array, std::uint32_t from) {
    if (!array.empty()) array[kept] = array[from];
  };
  for (SampleBlock block : samples.blocks) {
    const std::uint32_t begin = kept;
    std::array<std::uint32_t, 2> axis_begin{};
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) axis_begin[static_cast<std::size_t>(axis) - 1] = kept;
      for (std::uint32_t i = block.begin_of_axis(axis); i < block.end_of_axis(axis); ++i) {
        if (parts.area[parts.part[i]] < least_area) {
          samples.total_area -= samples.area[i];
          continue;
        }
        keep(samples.x, i), keep(samples.y, i), keep(samples.z, i), keep(samples.area, i);
        keep(samples.normal, i), keep(samples.edge, i), keep(samples.source, i);
        ++kept;
      }
    }
    if (kept > begin) blocks.push_back({begin, kept, block.brick, axis_begin});
  }
  samples.blocks = std::move(blocks);
  samples.x.resize(kept), samples.y.resize(kept), samples.z.resize(kept), samples.area.resize(kept);
  samples.normal.resize(kept), samples.edge.resize(kept);
  if (!samples.source.empty()) samples.source.resize(kept);
  return dropped;
}

}  // namespace evenmesh
