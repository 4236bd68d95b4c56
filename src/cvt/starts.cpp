#include "cvt/starts.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>

#include "core/random.h"
#include "geometry/point_hash.h"

namespace evenmesh {
namespace {

Vec3 sample_position(const SampleSet& samples, std::size_t block, std::size_t i) {
  return samples.block_center(samples.blocks[block]) + Vec3{samples.x[i], samples.y[i], samples.z[i]};
}

/// A pair of neighbouring cells, seen from the sample nearest to the middle of their seeds.
struct Border {
  std::uint64_t pair;  ///< lower seed << 32 | higher seed
  float distance;      ///< of that sample to the middle, squared
  std::uint32_t sample, block;
  friend bool operator<(const Border& a, const Border& b) {
    return a.pair != b.pair           ? a.pair < b.pair
           : a.distance != b.distance ? a.distance < b.distance
                                      : a.sample < b.sample;
  }
};

/// One Border for every two cells that share a sample's footprint.
std::vector<Border> borders(CellEvaluator& evaluator, const std::vector<Vec3>& seeds, ExecutionContext& context) {
  const SampleSet& samples = evaluator.samples();
  std::vector<NearestPair> nearest;
  evaluator.nearest_pairs(seeds, nearest);
  std::vector<std::vector<Border>> of_chunk((samples.blocks.size() + 63) / 64);
  parallel_tasks(context, of_chunk.size(), [&](std::size_t chunk) {
    auto& list = of_chunk[chunk];
    for (std::size_t b = 64 * chunk; b < std::min(samples.blocks.size(), 64 * (chunk + 1)); ++b)
      for (std::uint32_t i = samples.blocks[b].begin; i < samples.blocks[b].end; ++i) {
        const auto [s, t, distance] = nearest[i];
        if (s == t || distance > 0.7f * std::sqrt(samples.area[i])) continue;
        const Vec3 middle = 0.5 * (seeds[s] + seeds[t]);
        const auto off = static_cast<float>(squared_norm(sample_position(samples, b, i) - middle));
        list.push_back({std::uint64_t{std::min(s, t)} << 32 | std::max(s, t), off, i, static_cast<std::uint32_t>(b)});
      }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end(), [](const Border& x, const Border& y) { return x.pair == y.pair; }),
               list.end());
  });
  std::vector<Border> all;
  for (const auto& list : of_chunk) all.insert(all.end(), list.begin(), list.end());
  tbb::parallel_sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end(), [](const Border& x, const Border& y) { return x.pair == y.pair; }),
            all.end());
  return all;
}

/// A sample that was drawn.
struct Drawn {
  std::size_t block, sample;
};

/// Systematic sampling: one draw from each of `count` parts of equal share; the rest, if any, anywhere.
std::vector<Drawn> draw(const SampleSet& samples, std::size_t count, std::uint64_t seed) {
  std::vector<Drawn> drawn;
  drawn.reserve(count);
  Random random(seed);
  double total = samples.total_area;
  if (!samples.even()) {
    total = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) total += samples.share(i);
  }
  double passed = 0, target = random.uniform() * total / static_cast<double>(count);
  for (std::size_t b = 0; b < samples.blocks.size(); ++b)
    for (std::size_t i = samples.blocks[b].begin; i < samples.blocks[b].end; ++i) {
      passed += samples.share(i);
      while (drawn.size() < count && passed > target) {
        drawn.push_back({b, i});
        target = (static_cast<double>(drawn.size()) + random.uniform()) * total / static_cast<double>(count);
      }
    }
  while (drawn.size() < count) {
    const std::size_t b = random.below(samples.blocks.size());
    const SampleBlock& block = samples.blocks[b];
    drawn.push_back({b, block.begin + random.below(block.end - block.begin)});
  }
  return drawn;
}

/// Edge length wanted at a sample, compared with that of an even mesh of as many vertices.
double relative_edge(const SampleSet& samples, std::size_t i) {
  const double share = samples.share(i);
  return samples.even() || !(share > 0) ? 1 : std::sqrt(samples.area[i] / share);
}

}  // namespace

std::vector<Vec3> random_start(const SampleSet& samples, std::size_t count, std::uint64_t seed) {
  std::vector<Vec3> seeds;
  seeds.reserve(count);
  for (const Drawn& d : draw(samples, count, seed)) seeds.push_back(sample_position(samples, d.block, d.sample));
  return seeds;
}

std::vector<Vec3> blue_noise_start(const SampleSet& samples, std::size_t count, std::uint64_t seed) {
  const std::size_t many = std::min(samples.size(), 4 * count);
  if (many <= count) return random_start(samples, count, seed);
  std::vector<Vec3> points;
  std::vector<double> size;  // relative edges
  for (const Drawn& d : draw(samples, many, seed)) {
    points.push_back(sample_position(samples, d.block, d.sample));
    size.push_back(relative_edge(samples, d.sample));
  }
  // Radius of a disk in the densest packing of `count` disks on the area.
  const double radius = std::sqrt(samples.total_area / (2 * std::sqrt(3.0) * static_cast<double>(count)));
  const double reach = 2 * radius, side = reach * *std::max_element(size.begin(), size.end());
  const PointHash near(points, side, samples.grid.origin);
  std::vector<std::vector<std::pair<std::uint32_t, double>>> neighbours(many);
  std::vector<double> crowding(many, 0);
  for (std::size_t p = 0; p < many; ++p)
    near.near(points[p], side, [&](std::uint32_t q) {
      const double distance = norm(points[p] - points[q]), reach_here = reach * 0.5 * (size[p] + size[q]);
      if (q == p || distance >= reach_here) return;
      const double weight = std::pow(1 - distance / reach_here, 8);
      neighbours[p].push_back({q, weight});
      crowding[p] += weight;
    });
  std::priority_queue<std::pair<double, std::uint32_t>> queue;
  for (std::size_t p = 0; p < many; ++p) queue.push({crowding[p], static_cast<std::uint32_t>(p)});
  std::vector<char> removed(many, 0);
  for (std::size_t left = many; left > count;) {
    const auto [weight, p] = queue.top();
    queue.pop();
    if (removed[p] || weight != crowding[p]) continue;
    removed[p] = 1;
    --left;
    for (const auto& [q, w] : neighbours[p])
      if (!removed[q]) queue.push({crowding[q] -= w, q});
  }
  std::vector<Vec3> seeds;
  for (std::size_t p = 0; p < many; ++p)
    if (!removed[p]) seeds.push_back(points[p]);
  return seeds;
}

std::vector<Vec3> neighbour_middles(CellEvaluator& evaluator, const std::vector<Vec3>& seeds,
                                    ExecutionContext& context) {
  const SampleSet& samples = evaluator.samples();
  std::vector<Vec3> middles;
  for (const Border& border : borders(evaluator, seeds, context)) {
    const Vec3 middle = 0.5 * (seeds[border.pair >> 32] + seeds[border.pair & 0xffffffffu]);
    const Vec3 n = unpack_normal(samples.normal[border.sample]);
    middles.push_back(middle + n * dot(n, sample_position(samples, border.block, border.sample) - middle));
  }
  return middles;
}

void adjust_count(CellEvaluator& evaluator, Seeds& all, std::size_t count, std::uint64_t seed,
                  ExecutionContext& context) {
  std::vector<Vec3>& seeds = all.positions;
  context.throw_if_cancelled();
  if (seeds.size() == count) return;
  const SampleSet& samples = evaluator.samples();
  std::vector<std::uint32_t> labels;
  evaluator.nearest(seeds, labels);
  std::vector<double> share(seeds.size(), 0);
  for (std::size_t i = 0; i < labels.size(); ++i) share[labels[i]] += samples.share(i);
  const bool remove = seeds.size() > count;
  const std::size_t first = remove ? std::min(all.fixed.size(), count) : 0;
  std::vector<std::uint32_t> order(seeds.size() - first);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(first + i);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) {
    return share[a] != share[b] ? (remove ? share[a] < share[b] : share[a] > share[b]) : a < b;
  });
  if (remove) {
    std::vector<char> gone(seeds.size(), 0);
    for (std::size_t i = 0; i + count < seeds.size(); ++i) gone[order[i]] = 1;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < seeds.size(); ++i)
      if (!gone[i]) seeds[kept++] = seeds[i];
    seeds.resize(kept);
    return;
  }
  // A new seed goes to a random sample of a cell with a large share.
  std::vector<std::uint32_t> wanted(seeds.size(), 0);
  for (std::size_t i = 0; i + seeds.size() < count; ++i) ++wanted[order[i % order.size()]];
  Random random(seed);
  std::vector<Vec3> added;
  std::vector<std::uint32_t> seen(seeds.size(), 0);
  std::unordered_map<std::uint32_t, std::vector<Vec3>> places;
  for (std::size_t b = 0; b < samples.blocks.size(); ++b)
    for (std::size_t i = samples.blocks[b].begin; i < samples.blocks[b].end; ++i) {
      const std::uint32_t l = labels[i];
      if (wanted[l] == 0) continue;
      auto& place = places[l];  // reservoir of `wanted` samples
      ++seen[l];
      if (place.size() < wanted[l])
        place.push_back(sample_position(samples, b, i));
      else if (const auto at = random.below(seen[l]); at < wanted[l])
        place[at] = sample_position(samples, b, i);
    }
  for (std::size_t i = 0; i < order.size() && wanted[order[i]] > 0; ++i) {
    const auto it = places.find(order[i]);
    if (it == places.end()) continue;
    for (const Vec3& p : it->second)
      if (seeds.size() + added.size() < count) added.push_back(p);
  }
  seeds.insert(seeds.end(), added.begin(), added.end());
  if (seeds.size() == count) return;
  // Cells without samples, or with fewer than were wanted of them: the rest goes anywhere.
  const std::vector<Vec3> rest = random_start(samples, count - seeds.size(), seed + 1);
  seeds.insert(seeds.end(), rest.begin(), rest.end());
}

Seeds fixed_and_others(Seeds fixed, std::span<const Vec3> others, double reach) {
  const std::vector<Vec3> given = fixed.positions;
  const PointHash near(given, reach);
  const auto is_near = [&](const Vec3& p) {
    return near.near(p, reach, [&](std::uint32_t h) { return squared_norm(given[h] - p) < reach * reach; });
  };
  for (const Vec3& p : others)
    if (!is_near(p)) fixed.positions.push_back(p);
  return fixed;
}

}  // namespace evenmesh
