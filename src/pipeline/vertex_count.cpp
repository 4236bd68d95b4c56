#include <algorithm>
#include <cmath>

#include "pipeline/tessellator.h"

namespace evenmesh {
namespace {

constexpr int count_rounds = 3;      ///< attempts to meet the vertex count before the topology is repaired
constexpr int trim_rounds = 6;       ///< and after it
constexpr int trim_seed_rounds = 3;  ///< of seeds for the topology, after each of them
constexpr int trim_failures = 3;     ///< after which the topology is taken to need what it has

/// Vertices the mesh will have.
std::size_t vertices_of(const Tessellation& cells) {
  std::vector<char> used(cells.seeds.size(), 0);
  for (const Triangle& t : cells.complex.triangles)
    for (const std::uint32_t l : t) used[l] = 1;
  return static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
}

/// Fewer seeds or more, and what these need to fit together; balls are not among that.
void change_count(Tessellator& state, bool fewer, std::size_t change) {
  Tessellation& cells = state.result;
  state.timer.stage("relax", 0, [&] {
    if (fewer)
      remove_common_cells(cells.sampling.samples, cells.seeds, cells.labels, change);
    else
      state.adjust_count(cells.seeds.size() + change, 13);
  });
  state.relax(2);
  state.connect();
  for (int round = 0; round < trim_seed_rounds && !state.fits(); ++round) {
    const TopologyRepair repair = state.plan_repair({}, {});
    if (!repair.changed.empty()) return;
    state.forget_split_cells();
    cells.seeds.positions.insert(cells.seeds.positions.end(), repair.seeds.begin(), repair.seeds.end());
    state.relax();
    state.connect();
  }
}

}  // namespace

void meet_count(Tessellator& state) {
  const double wanted = static_cast<double>(state.wanted()), fixed = static_cast<double>(state.fixed());
  for (int round = 0; round < count_rounds; ++round) {
    const double made = static_cast<double>(state.result.complex.labels);
    if (made <= 1.001 * wanted) return;
    const double seeds = made - static_cast<double>(state.result.complex.pieces.size());
    if (made > 1.1 * wanted) {
      state.relax_all(static_cast<std::size_t>(std::max(4.0 + fixed, std::round(seeds * wanted / made))));
    } else {
      state.forget_split_cells();
      const std::size_t given = state.result.seeds.size();
      const std::size_t fewer = std::max(4 + state.fixed(), given - static_cast<std::size_t>(made - wanted));
      state.adjust_and_relax(std::min(given, fewer));
    }
    state.connect();
  }
}

void trim_count(Tessellator& state) {
  if (!state.fits()) return;
  Tessellation& cells = state.result;
  const auto wanted = static_cast<std::int64_t>(state.wanted()), tolerance = wanted / 1000;
  for (int attempt = 0, failures = 0; attempt < trim_rounds && failures < trim_failures; ++attempt) {
    const auto made = static_cast<std::int64_t>(vertices_of(cells)), excess = made - wanted;
    if (std::abs(excess) <= tolerance) return;
    auto seeds = cells.seeds;
    auto labels = cells.labels;
    auto complex = cells.complex;
    state.forget_split_cells();
    const std::size_t share = static_cast<std::size_t>(std::abs(excess)) * cells.seeds.size();
    const std::size_t change = share / static_cast<std::size_t>(made) >> failures;
    change_count(state, excess > 0, std::max<std::size_t>(1, change));
    const std::int64_t left = static_cast<std::int64_t>(vertices_of(cells)) - wanted;
    if (state.fits() && std::abs(left) < std::abs(excess)) continue;
    cells.seeds = std::move(seeds);
    cells.labels = std::move(labels);
    cells.complex = std::move(complex);
    ++failures;
  }
}

}  // namespace evenmesh
