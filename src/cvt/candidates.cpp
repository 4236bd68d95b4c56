#include "cvt/candidates.h"

#include <algorithm>
#include <cmath>

namespace evenmesh {
namespace {

/// Seeds in a uniform grid of cubic cells, in counting-sorted order.
class SeedGrid {
 public:
  SeedGrid(std::span<const Vec3> seeds, double total_area) {
    Box box;
    for (const Vec3& s : seeds) box.add(s);
    const double spacing = std::sqrt(total_area / static_cast<double>(seeds.size()));
    cell_ = std::max(1.5 * spacing, 1e-3 * box.longest_side() + 1e-300);
    origin_ = box.lo;
    for (int a = 0; a < 3; ++a) size_[a] = static_cast<int>(box.size()[a] / cell_) + 1;
    const std::size_t cells = std::size_t(size_[0]) * size_[1] * size_[2];
    start_.assign(cells + 1, 0);
    std::vector<std::uint32_t> cell_of(seeds.size());
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      const auto c = cell_at(seeds[i]);
      cell_of[i] = static_cast<std::uint32_t>(index(c[0], c[1], c[2]));
      ++start_[cell_of[i] + 1];
    }
    for (std::size_t c = 0; c < cells; ++c) start_[c + 1] += start_[c];
    order_.resize(seeds.size());
    position_.resize(seeds.size());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      const std::uint32_t at = next[cell_of[i]]++;
      order_[at] = static_cast<std::uint32_t>(i);
      position_[at] = seeds[i];
    }
  }

  /// Calls visit(seed, position) for the seeds in all cells that a box touches.
  template <typename Visit>
  void visit_box(const Box& box, const Visit& visit) const {
    const auto lo = cell_at(box.lo), hi = cell_at(box.hi);
    for (int k = lo[2]; k <= hi[2]; ++k)
      for (int j = lo[1]; j <= hi[1]; ++j) {
        const std::size_t row = index(0, j, k);
        for (std::uint32_t at = start_[row + lo[0]]; at < start_[row + hi[0] + 1]; ++at)
          visit(order_[at], position_[at]);
      }
  }
  double cell() const { return cell_; }

 private:
  std::array<int, 3> cell_at(const Vec3& p) const {
    std::array<int, 3> c{};
    for (int a = 0; a < 3; ++a) c[a] = std::clamp(static_cast<int>((p[a] - origin_[a]) / cell_), 0, size_[a] - 1);
    return c;
  }
  std::size_t index(int i, int j, int k) const { return (std::size_t(k) * size_[1] + j) * size_[0] + i; }

  Vec3 origin_;
  double cell_ = 1;
  std::array<int, 3> size_{};
  std::vector<std::uint32_t> start_, order_;
  std::vector<Vec3> position_;
};

/// The seeds around a chunk of blocks, and those of them that matter to one block.
class ChunkSeeds {
 public:
  ChunkSeeds(const SeedGrid& grid, std::span<const Vec3> seeds, std::span<const float> margins, float largest_margin)
      : grid_(grid), seeds_(seeds), margins_(margins), largest_margin_(largest_margin) {}

  /// Collects the seeds within `reach` of a box.
  void collect(Box box, double reach) {
    reach_ = reach;
    for (int a = 0; a < 3; ++a) box.lo[a] -= reach, box.hi[a] += reach;
    near_.clear();
    grid_.visit_box(box, [&](std::uint32_t seed, const Vec3& position) {
      if (box.contains(position)) near_.push_back(seed);
    });
    origin_ = box.center();
    const std::size_t capacity = (near_.size() + 7) / 8 * 8;
    for (auto* array : {&near_x_, &near_y_, &near_z_, &near_margin_, &scratch_}) array->resize(capacity);
    hits_.resize(capacity);
    for (std::size_t i = 0; i < near_.size(); ++i) {
      const Vec3 p = seeds_[near_[i]] - origin_;
      near_margin_[i] = margins_[near_[i]];
      near_x_[i] = static_cast<float>(p.x), near_y_[i] = static_cast<float>(p.y), near_z_[i] = static_cast<float>(p.z);
    }
  }

  /// Candidates of a block, ascending. False: they may lie beyond the reach; collect with needed() and ask again.
  bool candidates(const Vec3& block_center, const BlockBox& box, std::vector<std::uint32_t>& list) {
    const Vec3 center = block_center + Vec3{box.center[0], box.center[1], box.center[2]};
    const Vec3 from = center - origin_;
    const float at[3] = {static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)};
    const auto radius = static_cast<float>(norm({box.half[0], box.half[1], box.half[2]}));
    const SeedsInReach found = seeds_in_reach(at, radius, near_x_.data(), near_y_.data(), near_z_.data(),
                                              near_margin_.data(), near_.size(), scratch_.data(), hits_.data());
    const double needed = static_cast<double>(found.limit) + largest_margin_;
    if (needed > reach_ && near_.size() < seeds_.size()) {
      needed_ = near_.size() < 2 ? 2 * reach_ + grid_.cell() : needed;
      return false;
    }
    const std::size_t count = found.count, capacity = (count + 7) / 8 * 8;
    for (auto* array : {&x_, &y_, &z_, &margin_}) array->resize(capacity);
    seed_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t hit = hits_[i];
      const Vec3 offset = seeds_[near_[hit]] - block_center;
      x_[i] = static_cast<float>(offset.x), y_[i] = static_cast<float>(offset.y), z_[i] = static_cast<float>(offset.z);
      margin_[i] = near_margin_[hit], seed_[i] = near_[hit];
    }
    const std::size_t kept = keep_near_seeds(box, margin_.data(), x_.data(), y_.data(), z_.data(), seed_.data(), count);
    std::sort(seed_.begin(), seed_.begin() + static_cast<std::ptrdiff_t>(kept));  // ties go to the lower index
    list.insert(list.end(), seed_.begin(), seed_.begin() + static_cast<std::ptrdiff_t>(kept));
    return true;
  }
  double needed() const { return needed_; }

 private:
  const SeedGrid& grid_;
  std::span<const Vec3> seeds_;
  std::span<const float> margins_;
  double largest_margin_, reach_ = 0, needed_ = 0;
  std::vector<std::uint32_t> near_, hits_, seed_;
  Vec3 origin_;
  std::vector<float> near_x_, near_y_, near_z_, near_margin_, scratch_, x_, y_, z_, margin_;
};

}  // namespace

std::vector<BlockBox> block_boxes(const SampleSet& samples, const Run& run) {
  std::vector<BlockBox> boxes(samples.blocks.size());
  parallel_for(run, boxes.size(), 256, [&](std::size_t begin, std::size_t end) {
    const std::vector<float>* coordinate[3] = {&samples.x, &samples.y, &samples.z};
    for (std::size_t b = begin; b < end; ++b)
      for (int a = 0; a < 3; ++a) {
        const auto first = coordinate[a]->begin();
        const auto [lo, hi] = std::minmax_element(first + samples.blocks[b].begin, first + samples.blocks[b].end);
        boxes[b].center[a] = 0.5f * (*lo + *hi);
        boxes[b].half[a] = 0.5f * (*hi - *lo) * (1 + 1e-6f);
      }
  });
  return boxes;
}

CandidateLists::CandidateLists(const SampleSet& samples, const Run& run)
    : samples_(samples),
      boxes_(block_boxes(samples, run)),
      lists_((samples.blocks.size() + chunk - 1) / chunk),
      offsets_(samples.blocks.size()),
      counts_(samples.blocks.size()) {}

bool CandidateLists::still_valid(std::span<const Vec3> seeds) const {
  if (seeds_at_build_.size() != seeds.size()) return false;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    if (squared_norm(seeds[i] - seeds_at_build_[i]) > static_cast<double>(margins_[i]) * margins_[i]) return false;
  return true;
}

void CandidateLists::set_margins(std::span<const Vec3> seeds) {
  const double spacing = std::sqrt(samples_.total_area / static_cast<double>(seeds.size()));
  const bool moved = last_seeds_.size() == seeds.size();
  margins_.resize(seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const double step = moved ? 3 * norm(seeds[i] - last_seeds_[i]) : 0;
    margins_[i] = static_cast<float>(std::clamp(step, 0.05 * spacing, 0.5 * spacing));
  }
}

void CandidateLists::update(std::span<const Vec3> seeds, const Run& run) {
  if (still_valid(seeds)) {
    last_seeds_.assign(seeds.begin(), seeds.end());
    return;
  }
  set_margins(seeds);
  seeds_at_build_.assign(seeds.begin(), seeds.end());
  last_seeds_ = seeds_at_build_;
  const float largest_margin = *std::max_element(margins_.begin(), margins_.end());
  const SeedGrid grid(seeds, samples_.total_area);
  const double spacing = std::sqrt(samples_.total_area / static_cast<double>(seeds.size()));
  parallel_tasks(run, lists_.size(), [&](std::size_t c) {
    const std::size_t first = c * chunk, last = std::min((c + 1) * chunk, boxes_.size());
    ChunkSeeds near(grid, seeds, margins_, largest_margin);
    Box all;
    double radius = 0;
    for (std::size_t b = first; b < last; ++b) {
      const BlockBox& box = boxes_[b];
      const Vec3 half{box.half[0], box.half[1], box.half[2]};
      all.add(samples_.block_center(samples_.blocks[b]) + Vec3{box.center[0], box.center[1], box.center[2]});
      radius = std::max(radius, norm(half));
    }
    near.collect(all, 1.2 * spacing + 2 * radius + 2 * static_cast<double>(largest_margin));
    lists_[c].clear();
    for (std::size_t b = first; b < last; ++b) {
      const std::size_t before = lists_[c].size();
      while (!near.candidates(samples_.block_center(samples_.blocks[b]), boxes_[b], lists_[c]))
        near.collect(all, near.needed());
      offsets_[b] = static_cast<std::uint32_t>(before);
      counts_[b] = static_cast<std::uint32_t>(lists_[c].size() - before);
    }
  });
}

}  // namespace evenmesh
