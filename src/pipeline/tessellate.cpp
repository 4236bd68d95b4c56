#include "pipeline/tessellate.h"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/repair_progress.h"
#include "pipeline/tessellator.h"
#include "topology/regularize.h"

namespace evenmesh {
namespace {

constexpr int patience = 3;              ///< rounds without a fifth fewer defects until fragments are given up
constexpr int sheet_rounds = 12;         ///< of sheets, which have no inside for balls
constexpr int simplifying_rounds = 100;  ///< a ball grows up in ten of them
constexpr int releasing_from = 12;       ///< from here on without feature curves there
constexpr int perturbing_from = 5;       ///< round from which on every other one tries other seeds instead

/// Other seeds where some do not get along, however large the balls are.
void perturb(Tessellator& state, std::uint64_t round) {
  Seeds& seeds = state.result.seeds;
  std::vector<char> bad(seeds.size(), 0);
  for (const auto& [a, b] : state.defects()) bad[std::max(a, b)] = 1;
  const std::size_t given = state.given();
  std::vector<Vec3> kept;
  for (std::size_t s = 0; s < given; ++s)
    if (!bad[s] || seeds.is_fixed(s)) kept.push_back(seeds.positions[s]);
  seeds.positions = std::move(kept);
  state.timer.stage("relax", 0, [&] { state.adjust_count(given, round); });
  state.relax();
  state.connect();
}

/// One round of simplify_solid(): balls where cells do not fit together, and no more seeds than asked for.
void simplify_once(Tessellator& state, RegularizationBalls& list, int round) {
  Tessellation& cells = state.result;
  std::vector<BadEdge> edges;
  for (const auto& [a, b] : state.defects()) edges.push_back({cells.seeds.positions[a], cells.seeds.positions[b]});
  const std::vector<std::uint32_t> changed = list.next_round(edges);
  state.context.log(fmt::format("simplify {}: {} places, {} seeds, {} balls, {} new or grown", round, edges.size(),
                                cells.seeds.size(), list.balls().size(), changed.size()));
  const std::size_t pieces = std::min(cells.complex.pieces.size(), state.wanted());
  state.forget_split_cells();
  // Pieces of cells count as vertices too; fixed seeds stay.
  const std::size_t room = std::max({std::size_t{4}, state.fixed(), state.wanted() - pieces});
  if (cells.seeds.size() > room) state.timer.stage("relax", 0, [&] { state.adjust_count(room, 7); });
  cells.balls = BallIndex(list.balls());
  state.unite_changed(changed);
  state.relax();
  state.connect();
  if (!state.unconnected().empty()) state.clear_small_components();
}

}  // namespace

void simplify_solid(Tessellator& state) {
  RegularizationBalls list(state.result.sampling.samples.grid.spacing, state.edge());
  for (int round = 0; round < simplifying_rounds && !state.fits(); ++round) {
    if (round < perturbing_from || round % 2 == 0) {
      simplify_once(state, list, round);
      continue;
    }
    if (round >= releasing_from) state.release_features();
    perturb(state, static_cast<std::uint64_t>(round));
  }
}

void repair_sheets(Tessellator& state) {
  Tessellation& cells = state.result;
  RepairProgress progress;
  for (int round = 0; round < sheet_rounds && !state.fits(); ++round) {
    const std::size_t found = state.defects().size();
    if (progress.idle_after(found) > patience && state.options.connect == Connect::fragments) break;
    state.context.log(fmt::format("repair {}: {} defects, {} seeds", round, found, cells.seeds.size()));
    const TopologyRepair repair = state.plan_repair({}, {.seeds_only = true});
    state.forget_split_cells();
    state.insert(repair.seeds);
    // Seeds closer than a few samples would all be neighbours to fragments.
    if (state.options.connect == Connect::fragments) state.relax();
    state.connect();
  }
  if (state.options.topology == TopologyRule::simplify)
    cells.sampling.findings.push_back(make_finding(FindingCode::sheet_topology_kept));
}

Tessellation tessellate(Sampling sampling, const MeshOptions& options, const Kernels& kernels, StageTimer& timer,
                        ExecutionContext& context) {
  Tessellator state(std::move(sampling), options, kernels, timer, context);
  state.find_features();
  // Connectivity and shapes are improved afterwards; cells beside sharp edges have to fit.
  const double effort = state.fixed() > 0 ? 1 : 0.85;
  if (!seed_by_levels(state)) state.relax_all(state.wanted(), effort);
  state.connect();
  if (!state.closed()) {
    repair_sheets(state);
    state.result.two_manifold = state.result.complex.defects.empty();
    return std::move(state.result);
  }
  if (options.topology == TopologyRule::keep && fill_unresolved(state)) {
    state.find_features();
    state.relax_all(state.wanted());
    state.connect();
  }
  state.clear_small_components();
  meet_count(state);
  if (options.topology == TopologyRule::simplify)
    simplify_solid(state);
  else
    repair_solid(state);
  trim_count(state);
  if (const std::size_t released = state.result.released_curves; released > 0)
    state.result.sampling.findings.push_back(
        make_finding(FindingCode::features_released, {{"count", static_cast<double>(released)}}));
  state.result.two_manifold = state.fits();
  return std::move(state.result);
}

}  // namespace evenmesh
