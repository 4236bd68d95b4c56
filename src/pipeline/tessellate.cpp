#include "pipeline/tessellate.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "pipeline/tessellator.h"
#include "topology/ambiguous_faces.h"
#include "topology/regularize.h"

namespace evenmesh {
namespace {

constexpr int seed_rounds = 12;          ///< attempts to make every cell a disk with more seeds
constexpr int patience = 3;              ///< rounds without a fifth fewer defects until seeds are given up
constexpr int unresolvable_rounds = 2;   ///< attempts altogether where thin walls are missing: nothing helps there
constexpr int ball_rounds = 32;          ///< those, and attempts to change the topology where it resists
constexpr int topology_rounds = 50;      ///< attempts altogether; the last ones divide cells down to single samples
constexpr int sheet_rounds = 12;         ///< of sheets, which have no inside for balls
constexpr int simplifying_rounds = 100;  ///< a ball grows up in ten of them
constexpr int releasing_from = 12;       ///< from here on without feature curves there
constexpr int perturbing_from = 5;       ///< round from which on every other one tries other seeds instead

/// Counts the rounds in which the number of defects did not fall by a fifth.
class Progress {
 public:
  int idle_after(std::size_t defects) {
    idle_ = 10 * defects < 8 * fewest_ ? 0 : idle_ + 1;
    fewest_ = std::min(fewest_, defects);
    return idle_;
  }
  /// As if there had been as many idle rounds.
  void give_up(int rounds) { idle_ = rounds; }

 private:
  std::size_t fewest_ = std::numeric_limits<std::size_t>::max() / 8;
  int idle_ = 0;
};

void insert(Tessellation& cells, const std::vector<Vec3>& seeds) {
  cells.seeds.positions.insert(cells.seeds.positions.end(), seeds.begin(), seeds.end());
  cells.inserted_seeds += seeds.size();
}

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

void repair_solid(Tessellator& state) {
  Tessellation& cells = state.result;
  std::vector<Vec3> ambiguous;
  bool small_components_cleared = false, ambiguous_known = false;
  Progress progress;
  const int rounds = cells.sampling.unresolvable() ? unresolvable_rounds : topology_rounds;
  for (int round = 0; round < rounds && !state.fits(); ++round) {
    const std::size_t found = state.defects().size();
    const int idle = progress.idle_after(found);
    if (!ambiguous_known)
      ambiguous =
          state.timer.stage("connect", 0, [&] { return find_ambiguous_faces(cells.sampling.samples, state.context); });
    ambiguous_known = true;
    state.context.log(fmt::format("repair {}: {} defects, {} seeds, {} balls, {} ambiguous faces", round, found,
                                  cells.seeds.size(), cells.balls.balls().size(), ambiguous.size()));
    const bool last_resort = round >= ball_rounds, seeds_are_idle = round >= seed_rounds || idle >= patience;
    if (seeds_are_idle) progress.give_up(patience);
    const TopologyRepair repair =
        state.plan_repair(ambiguous, {.prefer_balls = seeds_are_idle, .seeds_only = last_resort});
    state.forget_split_cells();
    insert(cells, repair.seeds);
    if (!repair.changed.empty()) {
      cells.balls = BallIndex(repair.balls);
      state.unite_changed(repair.changed);
      ambiguous_known = false;
    }
    // Relaxing would draw seeds out of the narrow places they have been put into.
    if (!last_resort && (!seeds_are_idle || !repair.changed.empty())) state.relax();
    state.connect();
    if (small_components_cleared && repair.changed.empty()) continue;
    if (state.unconnected().empty()) continue;
    small_components_cleared = true;
    if (state.clear_small_components()) ambiguous_known = false;
  }
}

void simplify_solid(Tessellator& state) {
  RegularizationBalls list(state.result.sampling.samples.grid.spacing, state.edge());
  const std::size_t curves = state.result.features.curves.size();
  for (int round = 0; round < simplifying_rounds && !state.fits(); ++round) {
    if (round < perturbing_from || round % 2 == 0) {
      simplify_once(state, list, round);
      continue;
    }
    if (round >= releasing_from) state.release_features();
    perturb(state, static_cast<std::uint64_t>(round));
  }
  if (const std::size_t left = state.result.features.curves.size(); left < curves)
    state.result.sampling.findings.push_back(
        make_finding(FindingCode::features_released, {{"count", static_cast<double>(curves - left)}}));
}

void repair_sheets(Tessellator& state) {
  Tessellation& cells = state.result;
  Progress progress;
  for (int round = 0; round < sheet_rounds && !state.fits(); ++round) {
    const std::size_t found = state.defects().size();
    if (progress.idle_after(found) > patience && state.options.connect == Connect::fragments) break;
    state.context.log(fmt::format("repair {}: {} defects, {} seeds", round, found, cells.seeds.size()));
    const TopologyRepair repair = state.plan_repair({}, {.seeds_only = true});
    state.forget_split_cells();
    insert(cells, repair.seeds);
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
  state.relax_all(state.wanted());
  state.connect();
  if (!state.closed()) {
    repair_sheets(state);
    state.result.two_manifold = state.result.complex.defects.empty();
    return std::move(state.result);
  }
  state.clear_small_components();
  meet_count(state);
  if (options.topology == TopologyRule::simplify)
    simplify_solid(state);
  else
    repair_solid(state);
  trim_count(state);
  state.result.two_manifold = state.fits();
  return std::move(state.result);
}

}  // namespace evenmesh
