#include "cvt/candidates.h"

#include <algorithm>
#include <cmath>

namespace evenmesh {

/// Seeds in a uniform grid of cubic cells, in counting-sorted order.
class SeedGrid {
 public:
  SeedGrid(std::span<const Vec3> seeds, double spacing) {
    Box box;
    for (const Vec3& s : seeds) box.add(s);
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

namespace {

/// The seeds around a chunk of blocks, and those of them that matter to one block.
class ChunkSeeds {
 public:
  ChunkSeeds(const SeedGrid& grid, std::span<const Vec3> seeds, std::span<const float> margins, float largest_margin)
      : grid_(grid), seeds_(seeds), margins_(margins), largest_margin_(largest_margin) {}

  /// Collects the seeds within `reach` of a box.
  void collect(Box box, double reach) {
    reach_ = reach;
    for (int a = 0; a < 3; ++a) {
      box.lo[a] -= reach;
      box.hi[a] += reach;
    }
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
      near_x_[i] = static_cast<float>(p.x);
      near_y_[i] = static_cast<float>(p.y);
      near_z_[i] = static_cast<float>(p.z);
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
    needed_ = near_.size() < 2 ? 2 * reach_ + grid_.cell() : needed;
    if (needed > reach_ && near_.size() < seeds_.size()) return false;
    const std::size_t count = found.count, capacity = (count + 7) / 8 * 8;
    for (auto* array : {&x_, &y_, &z_, &margin_}) array->resize(capacity);
    seed_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t hit = hits_[i];
      const Vec3 offset = seeds_[near_[hit]] - block_center;
      x_[i] = static_cast<float>(offset.x);
      y_[i] = static_cast<float>(offset.y);
      z_[i] = static_cast<float>(offset.z);
      margin_[i] = near_margin_[hit];
      seed_[i] = near_[hit];
    }
    const std::size_t kept = keep_near_seeds(box, margin_.data(), x_.data(), y_.data(), z_.data(), seed_.data(), count);
    std::sort(seed_.begin(), seed_.begin() + static_cast<std::ptrdiff_t>(kept));  // ties go to the lower index
    list.insert(list.end(), seed_.begin(), seed_.begin() + static_cast<std::ptrdiff_t>(kept));
    return true;
  }
  /// How far from the centre of the block asked for last there may be seeds that matter to it.
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

std::vector<BlockBox> block_boxes(const SampleSet& samples, const ExecutionContext& context) {
  std::vector<BlockBox> boxes(samples.blocks.size());
  parallel_for(context, boxes.size(), 256, [&](std::size_t begin, std::size_t end) {
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

CandidateLists::CandidateLists(const SampleSet& samples, const ExecutionContext& context)
    : samples_(samples),
      boxes_(block_boxes(samples, context)),
      chunks_((samples.blocks.size() + chunk - 1) / chunk),
      reach_(samples.blocks.size()),
      offsets_(samples.blocks.size()),
      counts_(samples.blocks.size()) {}

bool CandidateLists::is_valid_for(std::size_t seed, const Vec3& at) const {
  return squared_norm(at - seeds_at_build_[seed]) <= static_cast<double>(margins_[seed]) * margins_[seed];
}

float CandidateLists::margin(std::size_t seed, const Vec3& at, double spacing) const {
  const double step = last_seeds_.empty() ? 0 : 3 * norm(at - last_seeds_[seed]);
  return static_cast<float>(std::clamp(step, 0.12 * spacing, 0.5 * spacing));
}

void CandidateLists::update(std::span<const Vec3> seeds, const ExecutionContext& context) {
  const double spacing = std::sqrt(samples_.total_area / static_cast<double>(seeds.size()));
  if (last_seeds_.size() != seeds.size()) {
    seeds_at_build_.clear();
    last_seeds_.clear();
  }
  std::vector<std::uint32_t> strayed;
  for (std::size_t i = 0; i < seeds_at_build_.size(); ++i)
    if (!is_valid_for(i, seeds[i])) strayed.push_back(static_cast<std::uint32_t>(i));
  if (seeds_at_build_.empty() || 8 * strayed.size() > seeds.size()) {
    build_all(seeds, spacing, context);
  } else if (!strayed.empty()) {
    build_around(strayed, seeds, spacing, context);
  }
  last_seeds_.assign(seeds.begin(), seeds.end());
}

void CandidateLists::build_all(std::span<const Vec3> seeds, double spacing, const ExecutionContext& context) {
  margins_.resize(seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) margins_[i] = margin(i, seeds[i], spacing);
  largest_margin_ = *std::max_element(margins_.begin(), margins_.end());
  seeds_at_build_.assign(seeds.begin(), seeds.end());
  const SeedGrid grid(seeds_at_build_, spacing);
  parallel_tasks(context, chunks_.size(), [&](std::size_t c) {
    std::array<bool, chunk> all;
    all.fill(true);
    build_chunk(c, all, grid, spacing);
  });
}

/// Lists in which none of the strayed seeds was or can be now stay as they are: there, the others have kept within
/// their margins.
void CandidateLists::build_around(std::span<const std::uint32_t> strayed, std::span<const Vec3> seeds, double spacing,
                                  const ExecutionContext& context) {
  std::vector<Vec3> places;
  for (const std::uint32_t i : strayed) {
    places.push_back(seeds_at_build_[i]);
    places.push_back(seeds[i]);
    margins_[i] = std::min(margin(i, seeds[i], spacing), largest_margin_);
    seeds_at_build_[i] = seeds[i];
  }
  const SeedGrid grid(seeds_at_build_, spacing), changed(places, spacing);
  parallel_tasks(context, chunks_.size(), [&](std::size_t c) {
    std::array<bool, chunk> stale{};
    bool any = false;
    changed.visit_box(chunks_[c].region, [&](std::uint32_t, const Vec3& p) {
      if (!chunks_[c].region.contains(p)) return;
      for (std::size_t b = c * chunk; b < end_of_chunk(c); ++b)
        if (squared_norm(p - center(b)) <= double(reach_[b]) * reach_[b]) stale[b - c * chunk] = any = true;
    });
    if (any) build_chunk(c, stale, grid, spacing);
  });
}

/// The lists of those blocks of a chunk that are stale.
void CandidateLists::build_chunk(std::size_t c, const std::array<bool, chunk>& stale, const SeedGrid& grid,
                                 double spacing) {
  const std::size_t first = c * chunk, last = end_of_chunk(c);
  Box centers;
  double radius = 0;
  for (std::size_t b = first; b < last; ++b) {
    if (!stale[b - first]) continue;
    centers.add(center(b));
    radius = std::max(radius, norm({boxes_[b].half[0], boxes_[b].half[1], boxes_[b].half[2]}));
  }
  ChunkSeeds near(grid, seeds_at_build_, margins_, largest_margin_);
  near.collect(centers, 1.2 * spacing + 2 * radius + 2 * static_cast<double>(largest_margin_));
  std::vector<std::uint32_t> list;
  Box region;
  for (std::size_t b = first; b < last; ++b) {
    const auto before = static_cast<std::uint32_t>(list.size());
    if (stale[b - first]) {
      while (!near.candidates(samples_.block_center(samples_.blocks[b]), boxes_[b], list))
        near.collect(centers, near.needed());
      reach_[b] = static_cast<float>(near.needed() * (1 + 1e-6));
    } else {
      const auto kept = of_block(b);
      list.insert(list.end(), kept.begin(), kept.end());
    }
    offsets_[b] = before;
    counts_[b] = static_cast<std::uint32_t>(list.size()) - before;
    const Vec3 reach = double(reach_[b]) * Vec3{1, 1, 1};
    region.add(center(b) - reach);
    region.add(center(b) + reach);
  }
  chunks_[c] = {std::move(list), region};
}

}  // namespace evenmesh
