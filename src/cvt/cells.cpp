#include "cvt/cells.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "core/sums.h"
#include "cvt/candidates.h"
#include "cvt/cell_kernels.h"

namespace evenmesh {
namespace {

/// Radius of a footprint in units of the spacing of its axis' samples on the surface, h/√|n_a|. A square of that side
/// has the same variance at 0.645; wider ones blur short edges of cells, narrower ones leave noise (docs/cvt.md).
constexpr double footprint_radius = 0.7;
/// Rays that graze the surface have long footprints and little weight; the radius does not grow below this |n_a|.
constexpr double min_slope = 0.25;

/// So many candidates are tried as they are; more are sorted out first.
constexpr std::size_t few_candidates = 8;

/// Blocks that one task takes, neighbours mostly: they have a few hundred cells.
constexpr std::size_t batch = 128;

/// Mass and moments of a cell as 64-bit fixed-point numbers: their sum does not depend on the order.
using FixedSums = std::array<std::int64_t, 4>;

/// The sums of the cells that one batch of blocks meets, found by seed: a hash table with open addressing.
class BatchSums {
 public:
  FixedSums& of(std::uint32_t seed) {
    if (2 * entries_.size() >= places_.size()) grow();
    std::uint32_t& place = find(seed);
    if (place == none) {
      place = static_cast<std::uint32_t>(entries_.size());
      entries_.push_back({{}, seed});
    }
    return entries_[place].sums;
  }
  /// Adds them to those of all cells.
  void add_to(std::vector<FixedSums>& cells) const {
    for (const Entry& entry : entries_)
      for (std::size_t i = 0; i < 4; ++i) cells[entry.seed][i] += entry.sums[i];
  }
  void clear() {
    entries_.clear();
    std::fill(places_.begin(), places_.end(), none);
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  struct Entry {
    FixedSums sums;
    std::uint32_t seed;
  };
  std::uint32_t& find(std::uint32_t seed) {
    std::size_t at = (seed * 0x9e3779b1u) >> shift_;
    while (places_[at] != none && entries_[places_[at]].seed != seed) at = at + 1 < places_.size() ? at + 1 : 0;
    return places_[at];
  }
  void grow() {
    places_.assign(2 * places_.size(), none);
    --shift_;
    for (std::uint32_t e = 0; e < entries_.size(); ++e) find(entries_[e].seed) = e;
  }

  std::vector<Entry> entries_;
  std::vector<std::uint32_t> places_ = std::vector<std::uint32_t>(1024, none);  ///< 2^(32 − shift) of them
  unsigned shift_ = 22;
};

/// Seeds of one block in single precision, and its sums.
struct Workspace {
  std::vector<float> seeds, sums;
  std::vector<float> lane_sums;
  std::vector<std::uint32_t> candidates, first, second;
  std::vector<float> distance;
  BatchSums cells;

  Workspace(std::size_t largest_block) {
    first.resize(largest_block);
    second.resize(largest_block);
    distance.resize(largest_block);
  }
};

}  // namespace

struct CpuCellEvaluator::State {
  const SampleSet& samples;
  ExecutionContext& context;
  CandidateLists lists;
  float footprint, min_area;
  std::size_t largest_block = 0;
  std::vector<double> block_energy;
  double footprint_energy = 0;
  std::vector<FixedSums> cells;  ///< by seed
  std::mutex cells_mutex;
  tbb::enumerable_thread_specific<std::unique_ptr<Workspace>> workspaces;

  State(const SampleSet& s, ExecutionContext& r)
      : samples(s),
        context(r),
        lists(s, r),
        footprint(static_cast<float>(footprint_radius * s.grid.spacing * s.grid.spacing)),
        min_area(static_cast<float>(min_slope * s.grid.spacing * s.grid.spacing)) {
    for (const SampleBlock& b : s.blocks) largest_block = std::max<std::size_t>(largest_block, b.end - b.begin);
    block_energy.resize(s.blocks.size());
    // The second moment of the footprints about their own centres, 2/5·R² each: constant, but part of F.
    const std::span<const float> weight = s.weights();
    footprint_energy = ordered_sum(context, s.size(), [&](std::size_t i) {
      return 0.4 * static_cast<double>(weight[i]) * footprint * footprint / std::max(s.area[i], min_area);
    });
  }

  /// Calls work(block index, view, candidates, workspace) for every block, in parallel, and finish(workspace) after
  /// every batch of them.
  template <typename Work, typename Finish>
  void for_blocks(std::span<const Vec3> seeds, const Work& work, const Finish& finish) {
    parallel_tasks(context, (samples.blocks.size() + batch - 1) / batch, [&](std::size_t task) {
      auto& workspace = workspaces.local();
      if (!workspace) workspace = std::make_unique<Workspace>(largest_block);
      for (std::size_t b = task * batch; b < std::min((task + 1) * batch, samples.blocks.size()); ++b) {
        const SampleBlock& block = samples.blocks[b];
        const auto listed = lists.of_block(b);
        const Vec3 center = samples.block_center(block);
        const std::size_t capacity = (listed.size() + 7) / 8 * 8;
        workspace->seeds.resize(3 * capacity);
        workspace->candidates.assign(listed.begin(), listed.end());
        float *sx = workspace->seeds.data(), *sy = sx + capacity, *sz = sy + capacity;
        for (std::size_t c = 0; c < listed.size(); ++c) {
          const Vec3 offset = seeds[listed[c]] - center;
          sx[c] = static_cast<float>(offset.x);
          sy[c] = static_cast<float>(offset.y);
          sz[c] = static_cast<float>(offset.z);
        }
        std::size_t n = listed.size();
        if (n > few_candidates) n = keep_near_seeds(lists.box(b), nullptr, sx, sy, sz, workspace->candidates.data(), n);
        const std::span<const std::uint32_t> candidates(workspace->candidates.data(), n);
        const std::size_t at = block.begin;
        const BlockView view{.x = samples.x.data() + at,
                             .y = samples.y.data() + at,
                             .z = samples.z.data() + at,
                             .area = samples.area.data() + at,
                             .weight = samples.weights().data() + at,
                             .footprint = footprint,
                             .min_area = min_area,
                             .samples = block.end - at,
                             .seed_x = sx,
                             .seed_y = sy,
                             .seed_z = sz,
                             .seeds = n};
        work(b, view, candidates, *workspace);
      }
      finish(*workspace);
    });
  }
  template <typename Work>
  void for_blocks(std::span<const Vec3> seeds, const Work& work) {
    for_blocks(seeds, work, [](Workspace&) {});
  }
};

CpuCellEvaluator::CpuCellEvaluator(const SampleSet& samples, ExecutionContext& context)
    : state_(std::make_unique<State>(samples, context)) {}
CpuCellEvaluator::~CpuCellEvaluator() = default;
std::unique_ptr<CellEvaluator> CpuCellEvaluator::for_samples(const SampleSet& samples,
                                                             ExecutionContext& context) const {
  return std::make_unique<CpuCellEvaluator>(samples, context);
}
const SampleSet& CpuCellEvaluator::samples() const {
  return state_->samples;
}

void CpuCellEvaluator::evaluate(std::span<const Vec3> seeds, CellSums& sums) {
  State& state = *state_;
  state.lists.update(seeds, state.context);
  // Masses add up to `weight`, moments to less than weight × extent: 2^61 leaves room for rounding.
  const double weight = state.samples.total_weight;
  const Grid& grid = state.samples.grid;
  const double extent = grid.spacing * std::max({grid.size[0], grid.size[1], grid.size[2]});
  const double mass_unit = weight * 0x1p-60, moment_unit = weight * extent * 0x1p-60;
  state.cells.assign(seeds.size(), {});
  state.for_blocks(
      seeds,
      [&](std::size_t b, const BlockView& view, std::span<const std::uint32_t> candidates, Workspace& work) {
        const std::size_t n = candidates.size();
        work.sums.resize(4 * n);
        work.lane_sums.resize(lane_sums_per_seed * n);
        const BlockSums out{work.sums.data(), work.sums.data() + n, work.sums.data() + 2 * n, work.sums.data() + 3 * n};
        state.block_energy[b] = evaluate_block(view, work.lane_sums.data(), out);
        const double to_mass = 1 / mass_unit, to_moment = 1 / moment_unit;
        for (std::size_t c = 0; c < n; ++c) {
          if (out.mass[c] == 0 && out.mx[c] == 0) continue;
          FixedSums& cell = work.cells.of(candidates[c]);
          cell[0] += static_cast<std::int64_t>(out.mass[c] * to_mass);
          cell[1] += static_cast<std::int64_t>(out.mx[c] * to_moment);
          cell[2] += static_cast<std::int64_t>(out.my[c] * to_moment);
          cell[3] += static_cast<std::int64_t>(out.mz[c] * to_moment);
        }
      },
      [&](Workspace& work) {
        {
          const std::lock_guard lock(state.cells_mutex);
          work.cells.add_to(state.cells);
        }
        work.cells.clear();
      });
  sums.mass.assign(seeds.size(), 0);
  sums.moment.assign(seeds.size(), {});
  parallel_for(state.context, seeds.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const FixedSums& total = state.cells[i];
      sums.mass[i] = total[0] * mass_unit;
      sums.moment[i] = Vec3{double(total[1]), double(total[2]), double(total[3])} * moment_unit;
    }
  });
  sums.energy = state.footprint_energy;
  for (const double e : state.block_energy) sums.energy += e;
}

void CpuCellEvaluator::nearest(std::span<const Vec3> seeds, std::vector<std::uint32_t>& labels) {
  State& state = *state_;
  state.lists.update(seeds, state.context);
  labels.resize(state.samples.size());
  state.for_blocks(seeds,
                   [&](std::size_t b, const BlockView& view, std::span<const std::uint32_t> candidates, Workspace&) {
                     std::uint32_t* out = labels.data() + state.samples.blocks[b].begin;
                     nearest_in_block(view, out);
                     for (std::size_t i = 0; i < view.samples; ++i) out[i] = candidates[out[i]];
                   });
}

void CpuCellEvaluator::nearest_pairs(std::span<const Vec3> seeds, std::vector<NearestPair>& pairs) {
  State& state = *state_;
  state.lists.update(seeds, state.context);
  pairs.resize(state.samples.size());
  state.for_blocks(
      seeds, [&](std::size_t b, const BlockView& view, std::span<const std::uint32_t> candidates, Workspace& work) {
        nearest_pair_in_block(view, work.first.data(), work.second.data(), work.distance.data());
        NearestPair* out = pairs.data() + state.samples.blocks[b].begin;
        for (std::size_t i = 0; i < view.samples; ++i)
          out[i] = {candidates[work.first[i]], candidates[work.second[i]], work.distance[i]};
      });
}

double energy_ratio(double energy, std::size_t seeds, double area) {
  return energy * static_cast<double>(seeds) / (area * area) / (5 / (18 * std::numbers::sqrt3));
}

}  // namespace evenmesh
