#include "connect/seed_graph.h"

#include <algorithm>
#include <cmath>

#include "cvt/candidates.h"
#include "geometry/point_hash.h"

namespace evenmesh {
namespace {

using Index = std::uint32_t;
using Pair = std::pair<Index, Index>;

template <typename Item>
void sort_unique(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

Pair ordered(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

/// What the samples of some blocks tell.
class Witness {
 public:
  std::vector<Pair> delaunay, candidates;
  std::vector<std::array<Index, 3>> corners;
  std::vector<SeedGroup> groups;

  /// @param near  (distance, seed) of at least two seeds: all within ε of the nearest; gets sorted
  void hear(std::vector<std::pair<double, Index>>& near) {
    std::sort(near.begin(), near.end());
    if (near.size() > 3) add_group(near);
    const std::size_t edges = std::min<std::size_t>(near.size(), 3);
    if (near[edges - 1].first == near[0].first) return;  // it cannot tell which are nearest
    const Index a = near[0].second, b = near[1].second;
    delaunay.push_back(ordered(a, b));
    if (edges < 3) return;
    const Index c = near[2].second;
    candidates.push_back(ordered(a, c));
    candidates.push_back(ordered(b, c));
    std::array<Index, 3> corner{a, b, c};
    std::sort(corner.begin(), corner.end());
    corners.push_back(corner);
  }

  void tidy() {
    sort_unique(delaunay);
    sort_unique(candidates);
    sort_unique(corners);
    sort_unique(groups);
  }

 private:
  void add_group(const std::vector<std::pair<double, Index>>& near) {
    SeedGroup group;
    group.fill(no_seed);
    for (std::size_t i = 0; i < std::min(near.size(), largest_group); ++i) group[i] = near[i].second;
    std::sort(group.begin(), group.end());
    groups.push_back(group);
  }
};

/// For one block after the other, the seeds that can be within ε of the nearest of one of its samples.
class Listener {
 public:
  Listener(const SampleSet& samples, const PointHash& seeds, double spacing, double margin)
      : samples_(samples), seeds_(seeds), spacing_(spacing), margin_(margin) {}

  void hear_block(const SampleBlock& block, const BlockBox& box, Witness& witness, std::vector<Index>& nearest) {
    const Vec3 origin = samples_.block_center(block);
    collect(origin + Vec3{box.center[0], box.center[1], box.center[2]}, norm({box.half[0], box.half[1], box.half[2]}));
    const std::size_t count = found_.size();
    x_.resize(count);
    y_.resize(count);
    z_.resize(count);
    squared_.resize(count);
    for (std::size_t c = 0; c < count; ++c) {
      const Vec3 at = seeds_[found_[c].second] - origin;
      x_[c] = at.x;
      y_[c] = at.y;
      z_[c] = at.z;
    }
    for (Index i = block.begin; i < block.end; ++i) {
      const double least = measure({samples_.x[i], samples_.y[i], samples_.z[i]});
      const double within = (std::sqrt(least) + margin_) * (std::sqrt(least) + margin_);
      near_.clear();
      nearest[i] = no_seed;
      for (std::size_t c = 0; c < count; ++c) {
        if (squared_[c] == least) nearest[i] = std::min(nearest[i], found_[c].second);
        if (squared_[c] <= within) near_.push_back({std::sqrt(squared_[c]), found_[c].second});
      }
      if (near_.size() > 1) witness.hear(near_);
    }
  }

 private:
  /// No point within `radius` of the centre is farther from its nearest seed than the centre is, plus `radius`.
  void collect(const Vec3& center, double radius) {
    double reach = radius + margin_ + spacing_;
    for (find(center, reach); found_.empty(); find(center, reach)) reach *= 2;
    const double least = std::sqrt(std::min_element(found_.begin(), found_.end())->first);
    const double needed = (least + 2 * radius + margin_) * (1 + 1e-6);
    if (needed > reach)
      find(center, needed);
    else
      std::erase_if(found_, [&](const auto& entry) { return entry.first > needed * needed; });
  }

  /// The seeds within `reach` of p, with their squared distances from it.
  void find(const Vec3& p, double reach) {
    found_.clear();
    seeds_.near(p, reach, [&](Index s) { found_.push_back({squared_norm(seeds_[s] - p), s}); });
  }

  /// Squared distances from p to all seeds found, and the least of them.
  double measure(const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < x_.size(); ++c) {
      const double dx = x_[c] - p.x, dy = y_[c] - p.y, dz = z_[c] - p.z;
      squared_[c] = dx * dx + dy * dy + dz * dz;
    }
    for (const double d : squared_) least = d < least ? d : least;
    return least;
  }

  const SampleSet& samples_;
  const PointHash& seeds_;
  double spacing_, margin_;
  std::vector<std::pair<double, Index>> found_, near_;
  std::vector<double> x_, y_, z_, squared_;  ///< of the seeds found, from the block's centre
};

template <typename Item>
void append(std::vector<Item>& to, const std::vector<Item>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

SeedGraph seed_graph(const SampleSet& samples, std::span<const Vec3> seeds, double margin, ExecutionContext& context) {
  constexpr std::size_t chunk = 64;  // blocks
  SeedGraph graph;
  graph.nearest.assign(samples.size(), 0);
  if (seeds.empty()) return graph;
  Box box;
  for (const Vec3& s : seeds) box.add(s);
  const double spacing = std::max(std::sqrt(samples.total_area / static_cast<double>(seeds.size())),
                                  box.longest_side() / (1 << 20) + 1e-300);
  const PointHash index(seeds, spacing, box.lo);
  const std::vector<BlockBox> boxes = block_boxes(samples, context);
  std::vector<Witness> witnesses((samples.blocks.size() + chunk - 1) / chunk);
  parallel_tasks(context, witnesses.size(), [&](std::size_t c) {
    Listener listener(samples, index, spacing, margin);
    for (std::size_t b = c * chunk; b < std::min(samples.blocks.size(), (c + 1) * chunk); ++b)
      listener.hear_block(samples.blocks[b], boxes[b], witnesses[c], graph.nearest);
    witnesses[c].tidy();
  });
  Witness all;
  for (const Witness& w : witnesses) {
    append(all.delaunay, w.delaunay);
    append(all.candidates, w.candidates);
    append(all.corners, w.corners);
    append(all.groups, w.groups);
  }
  all.tidy();
  graph.delaunay = std::move(all.delaunay);
  std::set_difference(all.candidates.begin(), all.candidates.end(), graph.delaunay.begin(), graph.delaunay.end(),
                      std::back_inserter(graph.candidates));
  graph.corners = std::move(all.corners);
  graph.groups = std::move(all.groups);
  return graph;
}

}  // namespace evenmesh
