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

  struct Hit {
    std::uint32_t seed;
    double distance;
    Vec3 offset;  ///< seed − centre
  };

  /// All seeds within (distance to the second nearest seed) + slack of `center`, ring by ring until nothing nearer can follow.
  void gather(const Vec3& center, double slack, std::vector<Hit>& hits) const {
    hits.clear();
    double best = infinity, second = infinity;
    std::array<int, 3> c{};
    double outside = 0;  // largest distance from the centre to the grid along an axis
    for (int a = 0; a < 3; ++a) {
      const double at = (center[a] - origin_[a]) / cell_;
      c[a] = std::clamp(static_cast<int>(std::floor(at)), 0, size_[a] - 1);
      outside = std::max({outside, -at, at - size_[a]});
    }
    const int last_ring = std::max({c[0], size_[0] - 1 - c[0], c[1], size_[1] - 1 - c[1], c[2], size_[2] - 1 - c[2]});
    for (int ring = 0; ring <= last_ring; ++ring) {
      if (outside <= 0 && (ring - 1) * cell_ > second + slack) break;
      visit_ring(c, ring, [&](std::size_t cell) {
        for (std::uint32_t at = start_[cell]; at < start_[cell + 1]; ++at) {
          const Vec3 offset = position_[at] - center;
          const double distance = norm(offset);
          if (distance > second + slack) continue;
          hits.push_back({order_[at], distance, offset});
          if (distance < best)
            second = best, best = distance;
          else if (distance < second)
            second = distance;
        }
      });
    }
    const double limit = second + slack;
    std::erase_if(hits, [&](const Hit& hit) { return hit.distance > limit; });
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  std::array<int, 3> cell_at(const Vec3& p) const {
    std::array<int, 3> c{};
    for (int a = 0; a < 3; ++a) c[a] = std::clamp(static_cast<int>((p[a] - origin_[a]) / cell_), 0, size_[a] - 1);
    return c;
  }
  std::size_t index(int i, int j, int k) const { return (std::size_t(k) * size_[1] + j) * size_[0] + i; }

  /// Calls visit(cell) for the cells at Chebyshev distance `ring` from c.
  template <typename Visit>
  void visit_ring(const std::array<int, 3>& c, int ring, const Visit& visit) const {
    for (int k = std::max(0, c[2] - ring); k <= std::min(size_[2] - 1, c[2] + ring); ++k)
      for (int j = std::max(0, c[1] - ring); j <= std::min(size_[1] - 1, c[1] + ring); ++j) {
        const bool face = std::abs(k - c[2]) == ring || std::abs(j - c[1]) == ring;
        const int step = face || ring == 0 ? 1 : 2 * ring;
        for (int i = c[0] - ring; i <= c[0] + ring; i += step)
          if (i >= 0 && i < size_[0]) visit(index(i, j, k));
      }
  }

  Vec3 origin_;
  double cell_ = 1;
  std::array<int, 3> size_{};
  std::vector<std::uint32_t> start_, order_;
  std::vector<Vec3> position_;
};

/// Leaves out the hits that cannot be among the two nearest seeds of any point of the box: those for which two other
/// seeds are nearer everywhere in it. |x − s|² − |x − t|² is linear in x, so its minimum over the box is at a corner.
void keep_near(const BlockBox& box, double margin, std::vector<SeedGrid::Hit>& hits, std::vector<SeedGrid::Hit>& nearest) {
  constexpr std::size_t judges = 5;
  if (hits.size() <= 2) return;
  nearest.assign(hits.begin(), hits.end());
  const std::size_t count = std::min(judges, nearest.size());
  std::partial_sort(nearest.begin(), nearest.begin() + count, nearest.end(),
                    [](const auto& a, const auto& b) { return a.distance != b.distance ? a.distance < b.distance : a.seed < b.seed; });
  const double radius = norm({box.half[0], box.half[1], box.half[2]});
  std::erase_if(hits, [&](const SeedGrid::Hit& hit) {
    int dominating = 0;
    for (std::size_t n = 0; n < count; ++n) {
      const SeedGrid::Hit& judge = nearest[n];
      if (judge.seed == hit.seed) continue;
      const double at_center = hit.distance * hit.distance - judge.distance * judge.distance;
      double swing = 0;
      for (int a = 0; a < 3; ++a) swing += std::abs(hit.offset[a] - judge.offset[a]) * box.half[a];
      // Seeds may each come or go by `margin`; differences of distances change by at most twice that.
      const double reach = hit.distance + judge.distance + 2 * radius;
      if (at_center - 2 * swing > 2 * margin * reach + 1e-6 * reach * reach) ++dominating;
      if (dominating == 2) return true;
    }
    return false;
  });
}

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

void CandidateLists::update(std::span<const Vec3> seeds, double margin, const Run& run) {
  if (margin_ >= 0 && seeds_at_build_.size() == seeds.size()) {
    double largest_move = 0;
    for (std::size_t i = 0; i < seeds.size(); ++i)
      largest_move = std::max(largest_move, squared_norm(seeds[i] - seeds_at_build_[i]));
    if (largest_move <= margin_ * margin_) return;
  }
  seeds_at_build_.assign(seeds.begin(), seeds.end());
  margin_ = margin;
  const SeedGrid grid(seeds, samples_.total_area);
  parallel_tasks(run, lists_.size(), [&](std::size_t c) {
    std::vector<SeedGrid::Hit> hits, nearest;
    lists_[c].clear();
    for (std::size_t b = c * chunk; b < std::min((c + 1) * chunk, boxes_.size()); ++b) {
      const BlockBox& box = boxes_[b];
      const Vec3 center =
          samples_.block_center(samples_.blocks[b]) + Vec3{box.center[0], box.center[1], box.center[2]};
      const double radius = norm({box.half[0], box.half[1], box.half[2]});
      grid.gather(center, 2 * radius + 4 * margin, hits);
      keep_near(box, margin, hits, nearest);
      std::sort(hits.begin(), hits.end(), [](const auto& a, const auto& b2) { return a.seed < b2.seed; });
      offsets_[b] = static_cast<std::uint32_t>(lists_[c].size());
      counts_[b] = static_cast<std::uint32_t>(hits.size());
      for (const auto& hit : hits) lists_[c].push_back(hit.seed);
    }
  });
  largest_ = *std::max_element(counts_.begin(), counts_.end());
}

}  // namespace evenmesh
