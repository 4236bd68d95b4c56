#include "refine/placement.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "geometry/quadric.h"

namespace evenmesh {
namespace {

constexpr double tikhonov = 0.5;  ///< weight of the centroid against the planes

struct Entry {
  std::uint32_t label;
  Quadric quadric;  ///< about the seed
};

/// One entry per label of the block, in order of first appearance.
void collect_block(const SampleSet& samples, const SampleBlock& block, std::span<const std::uint32_t> labels,
                   std::span<const Vec3> seeds, std::vector<Entry>& entries) {
  const Vec3 center = samples.block_center(block);
  const std::size_t first = entries.size();
  std::size_t at = first;
  for (std::uint32_t i = block.begin; i < block.end; ++i) {
    if (at >= entries.size() || entries[at].label != labels[i]) {
      at = first;
      while (at < entries.size() && entries[at].label != labels[i]) ++at;
      if (at == entries.size()) entries.push_back({labels[i], {}});
    }
    const Vec3 d = center + Vec3{samples.x[i], samples.y[i], samples.z[i]} - seeds[labels[i]];
    entries[at].quadric.add_plane(d, unpack_normal(samples.normal[i]), samples.area[i]);
  }
}

CellShape solve(const Quadric& planes, const Vec3& seed) {
  Quadric q = planes;
  const double area = q.weight();
  if (!(area > 0)) return {0, seed, seed, {}};
  const Vec3 to_centroid = q.mean();
  q.add_point(to_centroid, tikhonov * area);
  Vec3 move = q.minimum() - to_centroid;
  const double limit = 0.5 * std::sqrt(area / std::numbers::pi), length = norm(move);
  if (!std::isfinite(length)) move = {};
  if (length > limit) move *= limit / length;
  const Vec3 centroid = seed + to_centroid;
  return {area, centroid, centroid + move, planes};
}

/// What all blocks say of each label, in their order. Every thread reads all entries, and adds up those of its labels.
std::vector<Quadric> sums_by_label(const std::vector<std::vector<Entry>>& lists, std::size_t labels,
                                   const ExecutionContext& context) {
  constexpr std::size_t max_ranges = 8;
  const std::size_t ranges = std::min(threads_here(), max_ranges);
  std::vector<Quadric> quadrics(labels);
  parallel_tasks(context, ranges, [&](std::size_t range) {
    const std::size_t first = labels * range / ranges, last = labels * (range + 1) / ranges;
    for (const auto& list : lists)
      for (const Entry& e : list)
        if (e.label >= first && e.label < last) quadrics[e.label].add(e.quadric);
  });
  return quadrics;
}

}  // namespace

std::vector<CellShape> cell_shapes(const SampleSet& samples, std::span<const std::uint32_t> labels,
                                   std::span<const Vec3> seeds, ExecutionContext& context) {
  constexpr std::size_t chunk = 256;
  std::vector<std::vector<Entry>> entries((samples.blocks.size() + chunk - 1) / chunk);
  parallel_tasks(context, entries.size(), [&](std::size_t c) {
    for (std::size_t b = c * chunk; b < std::min(samples.blocks.size(), (c + 1) * chunk); ++b)
      collect_block(samples, samples.blocks[b], labels, seeds, entries[c]);
  });
  const std::vector<Quadric> quadrics = sums_by_label(entries, seeds.size(), context);
  std::vector<CellShape> shapes(seeds.size());
  parallel_for(context, seeds.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) shapes[i] = solve(quadrics[i], seeds[i]);
  });
  return shapes;
}

}  // namespace evenmesh
