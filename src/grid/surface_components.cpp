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

namespace {

/// The set without the samples of some components.
RemainingSurface without(SampleSet samples, const SurfaceComponents& parts, const std::vector<char>& dropped,
                         const ExecutionContext& context) {
  const auto count = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), 1));
  if (count == 0) return {std::move(samples), 0};
  return {keep_samples(
              samples, [&](std::uint32_t i) { return !dropped[parts.part[i]]; }, context),
          count};
}

}  // namespace

RemainingSurface drop_small_components(SampleSet samples, double min_area, ExecutionContext& context) {
  const SurfaceComponents parts = surface_components(samples, context);
  std::vector<double> share = parts.area;
  if (!samples.even()) {
    std::fill(share.begin(), share.end(), 0.0);
    for (std::size_t i = 0; i < samples.size(); ++i) share[parts.part[i]] += samples.share(i);
  }
  std::vector<char> dropped(parts.area.size(), 0);
  for (std::size_t p = 0; p < dropped.size(); ++p) dropped[p] = parts.area[p] < min_area && share[p] < min_area;
  return without(std::move(samples), parts, dropped, context);
}

namespace {

/// A crossing of a ray of x.
struct Crossing {
  std::uint64_t ray = 0;
  std::uint32_t cell = 0, part = 0;
  bool operator<(const Crossing& other) const { return ray != other.ray ? ray < other.ray : cell < other.cell; }
};

}  // namespace

RemainingSurface fill_cavities(SampleSet samples, ExecutionContext& context) {
  const SurfaceComponents parts = surface_components(samples, context);
  if (parts.area.size() < 2) return {std::move(samples), 0};
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
  return without(std::move(samples), parts, dropped, context);
}

}  // namespace evenmesh
