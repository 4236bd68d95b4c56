#include "connect/flood.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>

#include "grid/brick_union.h"

namespace evenmesh {
namespace {

using Link = std::pair<std::uint32_t, std::uint32_t>;

class Flood {
 public:
  Flood(const SampleSet& samples, std::vector<std::uint32_t>& labels, std::span<const Vec3> seeds,
        ExecutionContext& context)
      : samples_(samples), labels_(labels), seeds_(seeds), context_(context), bricks_(cube_bricks(samples, context)) {}

  std::size_t result() {
    find_strays();
    find_links();
    return grow();
  }

 private:
  double squared_distance(std::uint32_t sample, std::uint32_t label) const {
    return squared_norm(position_[sample] - seeds_[label]);
  }

  /// Samples that are not connected with the one next to their seed.
  void find_strays() {
    position_.resize(samples_.size());
    std::vector<std::pair<double, std::uint32_t>> next_to(seeds_.size(),
                                                          {std::numeric_limits<double>::infinity(), no_label});
    for (const SampleBlock& block : samples_.blocks)
      for (std::uint32_t i = block.begin; i < block.end; ++i) {
        position_[i] = samples_.block_center(block) + Vec3{samples_.x[i], samples_.y[i], samples_.z[i]};
        if (labels_[i] != no_label)
          next_to[labels_[i]] = std::min(next_to[labels_[i]], {squared_distance(i, labels_[i]), i});
      }
    const std::vector<std::uint32_t> root = component_roots(
        samples_, bricks_, context_, [&](std::uint32_t s, std::uint32_t t) { return labels_[s] == labels_[t]; });
    stray_.resize(samples_.size());
    for (std::uint32_t i = 0; i < samples_.size(); ++i)
      stray_[i] = labels_[i] != no_label && root[i] != root[next_to[labels_[i]].second];
  }

  /// Between strays and their neighbours, both ways round, sorted.
  void find_links() {
    std::vector<std::vector<Link>> found(bricks_.size());
    for_loops(samples_, bricks_, context_, [&](std::size_t b, const std::uint32_t* loop, int n) {
      for (int i = 0; i < n; ++i) {
        const std::uint32_t s = loop[i], t = loop[i + 1 == n ? 0 : i + 1];
        if (labels_[s] == no_label || labels_[t] == no_label) continue;
        if (stray_[t]) found[b].push_back({s, t});
        if (stray_[s]) found[b].push_back({t, s});
      }
    });
    for (const auto& list : found) links_.insert(links_.end(), list.begin(), list.end());
    parallel_sort(context_, links_);
  }

  std::size_t grow() {
    using Step = std::tuple<double, std::uint32_t, std::uint32_t>;  // squared distance, sample, label
    std::priority_queue<Step, std::vector<Step>, std::greater<>> front;
    const auto spread = [&](std::uint32_t from) {
      for (auto link = std::lower_bound(links_.begin(), links_.end(), Link{from, 0});
           link != links_.end() && link->first == from; ++link)
        if (stray_[link->second])
          front.push({squared_distance(link->second, labels_[from]), link->second, labels_[from]});
    };
    for (std::size_t i = 0; i < links_.size(); ++i)
      if (const std::uint32_t s = links_[i].first; !stray_[s] && (i == 0 || links_[i - 1].first != s)) spread(s);
    std::size_t changed = 0;
    for (std::size_t steps = 0; !front.empty(); ++steps) {
      if (steps % 65536 == 0) context_.throw_if_cancelled();
      const auto [distance, sample, label] = front.top();
      front.pop();
      if (!stray_[sample]) continue;
      stray_[sample] = 0;
      changed += labels_[sample] != label;
      labels_[sample] = label;
      spread(sample);
    }
    return changed;
  }

  const SampleSet& samples_;
  std::vector<std::uint32_t>& labels_;
  std::span<const Vec3> seeds_;
  ExecutionContext& context_;
  std::vector<CubeBrick> bricks_;
  std::vector<Vec3> position_;
  std::vector<char> stray_;
  std::vector<Link> links_;
};

}  // namespace

std::size_t flood_labels(const SampleSet& samples, std::vector<std::uint32_t>& labels, std::span<const Vec3> seeds,
                         ExecutionContext& context) {
  return Flood(samples, labels, seeds, context).result();
}

}  // namespace evenmesh
