#include "grid/surface_components.h"

#include <algorithm>

#include "grid/blocks.h"
#include "grid/brick_union.h"

namespace evenmesh {

SurfaceComponents surface_components(const SampleSet& samples, ExecutionContext& context) {
  const std::vector<std::uint32_t> roots = component_roots(samples, cube_bricks(samples, context), context,
                                                           [](std::uint32_t, std::uint32_t) { return true; });
  SurfaceComponents parts;
  parts.part.resize(samples.size());
  for (std::uint32_t i = 0; i < roots.size(); ++i) {
    const bool first = roots[i] == i;
    parts.part[i] = first ? static_cast<std::uint32_t>(parts.area.size()) : parts.part[roots[i]];
    if (first) parts.area.push_back(0);
    parts.area[parts.part[i]] += samples.area[i];
  }
  return parts;
}

std::vector<double> volumes_within(const SurfaceComponents& parts, const SampleSet& samples) {
  std::vector<double> volume(parts.area.size(), 0);
  for (const SampleBlock& block : samples.blocks)
    for (std::uint32_t s = block.begin; s < block.end_of_axis(0); ++s) {
      const double x = brick_size * block.brick[0] + samples.edge[s].i() + 0.5;
      volume[parts.part[s]] += samples.edge[s].lower_end_inside() ? x : -x;
    }
  return volume;
}

std::size_t drop_small_components(SampleSet& samples, double min_area, ExecutionContext& context) {
  const SurfaceComponents parts = surface_components(samples, context);
  const auto dropped = static_cast<std::size_t>(
      std::count_if(parts.area.begin(), parts.area.end(), [&](double a) { return a < min_area; }));
  if (dropped == 0) return 0;
  keep_samples(samples, [&](std::uint32_t i) { return parts.area[parts.part[i]] >= min_area; });
  return dropped;
}

namespace {

/// A crossing of a ray of x.
struct Crossing {
  std::uint64_t ray = 0;
  std::uint32_t cell = 0, part = 0;
  bool operator<(const Crossing& other) const { return ray != other.ray ? ray < other.ray : cell < other.cell; }
};

}  // namespace

std::size_t fill_cavities(SampleSet& samples, ExecutionContext& context) {
  const SurfaceComponents parts = surface_components(samples, context);
  if (parts.area.size() < 2) return 0;
  const std::vector<double> volume = volumes_within(parts, samples);
  std::vector<Crossing> crossings;
  for (const SampleBlock& block : samples.blocks)
    for (std::uint32_t s = block.begin; s < block.end_of_axis(0); ++s) {
      const EdgeCode edge = samples.edge[s];
      const std::uint32_t cell = brick_size * block.brick[0] + edge.i();
      const std::uint64_t j = brick_size * block.brick[1] + edge.j(), k = brick_size * block.brick[2] + edge.k();
      crossings.push_back({k << 16 | j, cell, parts.part[s]});
    }
  parallel_sort(context, crossings);
  // A part that lies within another one has an odd number of that one's crossings before its own.
  std::vector<char> dropped(volume.size(), 0), seen(volume.size(), 0);
  for (std::size_t p = 0; p < volume.size(); ++p) dropped[p] = volume[p] <= 0;
  std::vector<std::uint32_t> around;
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    if (i == 0 || crossings[i].ray != crossings[i - 1].ray) around.clear();
    const std::uint32_t part = crossings[i].part;
    if (volume[part] <= 0) continue;
    if (!seen[part]) {
      seen[part] = 1;
      dropped[part] = std::any_of(around.begin(), around.end(), [&](std::uint32_t other) { return other != part; });
    }
    const auto open = std::find(around.begin(), around.end(), part);
    open == around.end() ? around.push_back(part) : static_cast<void>(around.erase(open));
  }
  const auto count = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), 1));
  if (count > 0) keep_samples(samples, [&](std::uint32_t i) { return !dropped[parts.part[i]]; });
  return count;
}

}  // namespace evenmesh
