#include "cvt/candidates.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "core/grouping.h"

namespace evenmesh {

/// Seeds in rows along x, of square section, sorted along them: memory O(seeds + rows), whatever there is of empty
/// space.
class SeedGrid {
 public:
  SeedGrid(std::span<const Vec3> seeds, double spacing, const ExecutionContext& context) {
    const Box box = box_of(seeds, context);
    cell_ = std::max(1.5 * spacing, 1e-3 * box.longest_side() + 1e-300);
    origin_ = box.lo;
    for (int a = 0; a < 2; ++a) size_[a] = static_cast<int>(box.size()[a + 1] / cell_) + 1;
    const std::size_t rows = std::size_t(size_[0]) * size_[1];
    groups_ = group_by_key(context, seeds.size(), rows, [&](std::size_t i) {
      return static_cast<std::uint32_t>(row(row_at(seeds[i].y, 0), row_at(seeds[i].z, 1)));
    });
    position_.resize(seeds.size());
    constexpr std::size_t grain = 1024;
    parallel_for(context, rows, grain, [&](std::size_t begin, std::size_t end) {
      const auto item = [&](std::size_t r) { return groups_.items.begin() + groups_.start[r]; };
      for (std::size_t r = begin; r < end; ++r)
        std::sort(item(r), item(r + 1), [&](std::uint32_t s, std::uint32_t t) { return seeds[s].x < seeds[t].x; });
      for (std::size_t at = groups_.start[begin]; at < groups_.start[end]; ++at)
        position_[at] = seeds[groups_.items[at]];
    });
  }

  /// Calls visit(seed, position) for the seeds in a box, and some beside it.
  template <typename Visit>
  void visit_box(const Box& box, const Visit& visit) const {
    const int j0 = row_at(box.lo.y, 0), j1 = row_at(box.hi.y, 0), k0 = row_at(box.lo.z, 1), k1 = row_at(box.hi.z, 1);
    for (int k = k0; k <= k1; ++k)
      for (int j = j0; j <= j1; ++j) {
        const std::uint32_t end = groups_.start[row(j, k) + 1];
        const auto first = std::partition_point(position_.begin() + groups_.start[row(j, k)], position_.begin() + end,
                                                [&](const Vec3& p) { return p.x < box.lo.x; });
        for (auto at = static_cast<std::uint32_t>(first - position_.begin()); at < end; ++at) {
          if (position_[at].x > box.hi.x) break;
          visit(groups_.items[at], position_[at]);
        }
      }
  }
  double cell() const { return cell_; }

 private:
  static Box box_of(std::span<const Vec3> seeds, const ExecutionContext& context) {
    constexpr std::size_t piece = 1 << 16;
    std::vector<Box> boxes((seeds.size() + piece - 1) / piece);
    parallel_tasks(context, boxes.size(), [&](std::size_t p) {
      for (std::size_t i = p * piece; i < std::min(seeds.size(), (p + 1) * piece); ++i) boxes[p].add(seeds[i]);
    });
    Box all;
    for (const Box& box : boxes) {
      all.add(box.lo);
      all.add(box.hi);
    }
    return all;
  }
  /// @param a  0: y, 1: z
  int row_at(double coordinate, int a) const {
    return std::clamp(static_cast<int>((coordinate - origin_[a + 1]) / cell_), 0, size_[a] - 1);
  }
  std::size_t row(int j, int k) const { return std::size_t(k) * size_[0] + j; }

  Vec3 origin_;
  double cell_ = 1;
  int size_[2] = {1, 1};
  Groups groups_;  ///< seeds by row
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

namespace {

struct Range {
  float lo, hi;
};

/// Of count > 0 values. Four at a time, which keeps vector units busy.
Range range_of(const float* value, std::size_t count) {
  float lo[4], hi[4];
  std::fill_n(lo, 4, value[0]);
  std::fill_n(hi, 4, value[0]);
  const auto add = [&](std::size_t lane, float v) {
    lo[lane] = v < lo[lane] ? v : lo[lane];
    hi[lane] = hi[lane] < v ? v : hi[lane];
  };
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4)
    for (std::size_t lane = 0; lane < 4; ++lane) add(lane, value[i + lane]);
  for (; i < count; ++i) add(0, value[i]);
  return {std::min({lo[0], lo[1], lo[2], lo[3]}), std::max({hi[0], hi[1], hi[2], hi[3]})};
}

}  // namespace

std::vector<BlockBox> block_boxes(const SampleSet& samples, const ExecutionContext& context) {
  std::vector<BlockBox> boxes(samples.blocks.size());
  parallel_for(context, boxes.size(), 256, [&](std::size_t begin, std::size_t end) {
    const std::vector<float>* coordinate[3] = {&samples.x, &samples.y, &samples.z};
    for (std::size_t b = begin; b < end; ++b)
      for (int a = 0; a < 3; ++a) {
        const SampleBlock& block = samples.blocks[b];
        const auto [lo, hi] = range_of(coordinate[a]->data() + block.begin, block.end - block.begin);
        boxes[b].center[a] = 0.5f * (lo + hi);
        boxes[b].half[a] = 0.5f * (hi - lo) * (1 + 1e-6f);
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
  const std::vector<std::uint32_t> strayed = strayed_seeds(seeds, context);
  if (seeds_at_build_.empty() || 8 * strayed.size() > seeds.size()) {
    build_all(seeds, spacing, context);
  } else if (!strayed.empty()) {
    build_around(strayed, seeds, spacing, context);
  }
  last_seeds_.assign(seeds.begin(), seeds.end());
}

std::vector<std::uint32_t> CandidateLists::strayed_seeds(std::span<const Vec3> seeds,
                                                         const ExecutionContext& context) const {
  constexpr std::size_t piece = 1 << 14;
  std::vector<std::vector<std::uint32_t>> of_piece((seeds_at_build_.size() + piece - 1) / piece);
  parallel_tasks(context, of_piece.size(), [&](std::size_t p) {
    for (std::size_t i = p * piece; i < std::min(seeds_at_build_.size(), (p + 1) * piece); ++i)
      if (!is_valid_for(i, seeds[i])) of_piece[p].push_back(static_cast<std::uint32_t>(i));
  });
  std::vector<std::uint32_t> strayed;
  for (const auto& some : of_piece) strayed.insert(strayed.end(), some.begin(), some.end());
  return strayed;
}

ChunkSeeds CandidateLists::seeds_near(const SeedGrid& grid) const {
  return {grid, seeds_at_build_, margins_, largest_margin_};
}

void CandidateLists::build_all(std::span<const Vec3> seeds, double spacing, const ExecutionContext& context) {
  margins_.resize(seeds.size());
  parallel_for(context, seeds.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) margins_[i] = margin(i, seeds[i], spacing);
  });
  largest_margin_ = *std::max_element(margins_.begin(), margins_.end());
  seeds_at_build_.assign(seeds.begin(), seeds.end());
  const SeedGrid grid(seeds_at_build_, spacing, context);
  tbb::enumerable_thread_specific<ChunkSeeds> near([&] { return seeds_near(grid); });
  parallel_tasks(context, chunks_.size(), [&](std::size_t c) {
    std::array<bool, chunk> all;
    all.fill(true);
    build_chunk(c, all, near.local(), spacing);
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
  const SeedGrid grid(seeds_at_build_, spacing, context), changed(places, spacing, context);
  tbb::enumerable_thread_specific<ChunkSeeds> near([&] { return seeds_near(grid); });
  parallel_tasks(context, chunks_.size(), [&](std::size_t c) {
    const std::size_t first = c * chunk, count = end_of_chunk(c) - first;
    std::array<bool, chunk> stale{};
    std::array<Vec3, chunk> centers;
    bool any = false, known = false;
    changed.visit_box(chunks_[c].region, [&](std::uint32_t, const Vec3& p) {
      if (!chunks_[c].region.contains(p)) return;
      for (std::size_t b = 0; !known && b < count; ++b) centers[b] = center(first + b);
      known = true;
      for (std::size_t b = 0; b < count; ++b)
        if (squared_norm(p - centers[b]) <= double(reach_[first + b]) * reach_[first + b]) stale[b] = any = true;
    });
    if (any) build_chunk(c, stale, near.local(), spacing);
  });
}

/// The lists of those blocks of a chunk that are stale.
void CandidateLists::build_chunk(std::size_t c, const std::array<bool, chunk>& stale, ChunkSeeds& near,
                                 double spacing) {
  const std::size_t first = c * chunk, last = end_of_chunk(c);
  Box centers;
  double radius = 0;
  for (std::size_t b = first; b < last; ++b) {
    if (!stale[b - first]) continue;
    centers.add(center(b));
    radius = std::max(radius, norm({boxes_[b].half[0], boxes_[b].half[1], boxes_[b].half[2]}));
  }
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
