#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/repair_progress.h"
#include "pipeline/tessellator.h"
#include "topology/ambiguous_faces.h"

namespace evenmesh {
namespace {

constexpr int visits = 8;             ///< of places where cells do not fit together, before all is given up
constexpr int rounds_per_visit = 24;  ///< of seeds and filling in one visit; the last ones divide down to samples
constexpr int dividing_from = 16;
constexpr int most_seeds_per_cell = 4;  ///< in one round; one more every other round
constexpr double few = 20;              ///< defects of small meshes, which are no sign
/// Defects per vertex, above which the surface is too intricate for so few vertices, or for the grid.
constexpr double hopeless = 2;
constexpr int releasing_from = 6;   ///< sharp edges, where they do not fit however small the cells beside them are
constexpr int relaxing_rounds = 2;  ///< of all seeds there; then the new ones find their places alone
constexpr int seed_rounds = 12;     ///< attempts to make every cell a disk with more seeds
constexpr int patience = 3;         ///< rounds without a fifth fewer defects until seeds are given up
constexpr double work_limit = 24;   ///< rounds on as many samples as the surface has, altogether
constexpr double smallest_surface = 1e5;  ///< samples that such a round is counted as, at least
constexpr double seed_limit = 16;         ///< of the vertices asked for: what the topology may come to need
/// Defects per vertex and ambiguous faces per sample, above which the grid does not resolve the solid. Some such faces
/// are at sharp edges and where surface just reaches a layer of the grid; those do no harm, and there are no defects.
constexpr double torn = 0.01, crowded = 0.003;
constexpr double place_radius = 1;  ///< of places to be filled, in edges
/// Radii of balls, in edges, as in [Raster2Mesh §4.4].
constexpr int ball_rounds = 32;
constexpr double work_after_balls = 8;  ///< rounds for the rest
constexpr double first_ball = 0.5, ball_growth = 0.125, last_ball = 1;

std::vector<Vec3> ambiguous_faces(Tessellator& state) {
  return state.timer.stage("connect", 0,
                           [&] { return find_ambiguous_faces(state.result.sampling.samples, state.context); });
}

bool is_unresolved(Tessellator& state) {
  if (static_cast<double>(state.defects().size()) <= torn * static_cast<double>(state.wanted()) + few) return false;
  const auto faces = static_cast<double>(ambiguous_faces(state).size());
  return faces > crowded * static_cast<double>(state.result.sampling.samples.size());
}

class SolidRepair {
 public:
  explicit SolidRepair(Tessellator& whole) : whole_(whole), unresolved_(is_unresolved(whole)) {}

  void run() {
    if (whole_.fits() || whole_.result.sampling.unresolvable()) return;
    if (static_cast<double>(whole_.defects().size()) > hopeless * static_cast<double>(whole_.wanted()) + 10 * few)
      return;
    const SampleSet& samples = whole_.result.sampling.samples;
    work_left_ = work_limit * std::max(smallest_surface, static_cast<double>(samples.size()));
    if (unresolved_) unite_balls();
    for (int visit = 0; visit < visits && !whole_.fits() && !used_up(); ++visit) {
      visit_places(visit);
      spend(0.5, whole_);
      whole_.connect();
      if (fixed_seeds_are_in_the_way(whole_)) whole_.release_features();
      if (!whole_.unconnected().empty() && whole_.clear_small_components()) spend(1, whole_);
    }
    if (whole_.fits()) settle();
  }

 private:
  double size_of(const Tessellator& state) const { return static_cast<double>(state.result.sampling.samples.size()); }
  void spend(double rounds, const Tessellator& state) { work_left_ -= rounds * size_of(state); }
  bool used_up() const {
    return work_left_ <= 0 ||
           static_cast<double>(whole_.result.seeds.size()) > seed_limit * static_cast<double>(whole_.wanted()) + 1000;
  }

  /// Centres of the blocks with samples of cells that do not fit.
  static std::vector<Vec3> defective_places(const Tessellator& state) {
    const Tessellation& cells = state.result;
    const SampleSet& samples = cells.sampling.samples;
    std::vector<char> defective(cells.seeds.size(), 0);
    for (const auto& [a, b] : state.defects()) defective[a] = defective[b] = 1;
    std::vector<Vec3> places;
    for (const SampleBlock& block : samples.blocks)
      for (std::uint32_t i = block.begin; i < block.end; ++i)
        if (cells.labels[i] != no_label && defective[cells.labels[i]]) {
          places.push_back(samples.block_center(block));
          break;
        }
    return places;
  }

  static bool fixed_seeds_are_in_the_way(const Tessellator& state) {
    const auto defects = state.defects();
    return std::any_of(defects.begin(), defects.end(), [&](const Defect& d) { return d.first < state.fixed(); });
  }

  Tessellator& state() { return part_ ? *part_ : whole_; }

  /// Goes on with what lies around the cells that do not fit now, or with all of the surface when that is not much
  /// more.
  void narrow() {
    points_ = defective_places(state());
    if (part_) whole_.take_seeds(*part_);
    part_ = whole_.part_around(points_);
    state().connect();
    spend(0.5, state());
  }

  /// Relaxes all once more, if that tears nothing.
  void settle() {
    const Seeds seeds = whole_.result.seeds;
    const std::size_t pieces = whole_.result.complex.pieces.size();
    whole_.forget_split_cells();
    whole_.relax();
    whole_.connect();
    if (whole_.fits()) return;
    whole_.forget_split_cells();
    whole_.result.seeds = seeds;
    whole_.result.seeds.positions.resize(seeds.size() - pieces);
    whole_.connect();
  }

  /// Of a solid that the grid does not resolve: seeds, and balls wherever these do not help, on all of the surface.
  void unite_balls() {
    const double edge = whole_.edge();
    RepairProgress progress;
    for (int round = 0; round < ball_rounds && !whole_.fits() && !used_up(); ++round) {
      const std::size_t found = whole_.defects().size();
      const bool seeds_are_idle = progress.idle_after(found) >= patience || round >= seed_rounds;
      if (seeds_are_idle) progress.give_up(patience);
      const std::vector<Vec3> ambiguous = ambiguous_faces(whole_);
      whole_.context.log(fmt::format("balls {}: {} defects, {} seeds, {} balls, {} ambiguous faces", round, found,
                                     whole_.result.seeds.size(), whole_.result.balls.balls().size(), ambiguous.size()));
      const TopologyRepair repair = whole_.plan_repair(ambiguous, {.first_radius = first_ball * edge,
                                                                   .growth = ball_growth * edge,
                                                                   .last_radius = last_ball * edge,
                                                                   .prefer_places = seeds_are_idle,
                                                                   .unresolved = true});
      whole_.forget_split_cells();
      whole_.insert(repair.seeds);
      if (!repair.changed.empty()) {
        whole_.result.balls = BallIndex(repair.places);
        whole_.unite_changed(repair.changed);
      }
      if (!seeds_are_idle || !repair.changed.empty()) whole_.relax();
      whole_.connect();
      spend(1, whole_);
      if (!whole_.unconnected().empty()) whole_.clear_small_components();
    }
    work_left_ += work_after_balls * size_of(whole_);
  }

  void visit_places(int visit) {
    RepairProgress progress;
    std::size_t found_before = 0, fewest = state().defects().size();
    for (int round = 0; round < rounds_per_visit && !used_up() && !state().fits(); ++round) {
      const std::size_t found = state().defects().size();
      const int idle = progress.idle_after(found);
      if (round == 0 || 2 * found < found_before) {
        narrow();
        found_before = found;
      }
      const std::vector<Vec3> ambiguous = ambiguous_faces(state());
      whole_.context.log(fmt::format(
          "repair {}.{}: {} defects, {} seeds, {} places changed, {} ambiguous faces; {} samples", visit, round, found,
          state().result.seeds.size(), whole_.result.filled.balls().size() + whole_.result.balls.balls().size(),
          ambiguous.size(), size_of(state())));
      const bool dividing = round >= dividing_from, seeds_are_idle = round >= seed_rounds || idle >= patience;
      if (seeds_are_idle) progress.give_up(patience);
      fewest = std::min(fewest, found);
      if (round >= releasing_from && seeds_are_idle && fixed_seeds_are_in_the_way(state())) break;
      if (round >= dividing_from / 2 && found > fewest + fewest / 4 + 10) break;  // more seeds make it worse
      const TopologyRepair repair = state().plan_repair(ambiguous, options(round, seeds_are_idle));
      state().forget_split_cells();
      const std::size_t given = state().result.seeds.size();
      state().insert(repair.seeds);
      if (!repair.changed.empty()) fill(repair);
      // Relaxing all would draw seeds out of the narrow places they have been put into.
      if (round < relaxing_rounds)
        state().relax();
      else if (!dividing)
        state().relax_last(given);
      state().connect();
      spend(1, state());
    }
    if (part_) whole_.take_seeds(*part_);
    part_.reset();
  }

  TopologyRepairOptions options(int round, bool prefer_places) const {
    const double h = whole_.result.sampling.samples.grid.spacing, edge = whole_.edge();
    TopologyRepairOptions options{.prefer_places = prefer_places, .seeds_only = round >= dividing_from};
    options.seeds_per_cell = static_cast<std::size_t>(std::min(1 + round / 2, most_seeds_per_cell));
    options.first_radius = options.last_radius = std::max(4 * h, place_radius * edge);
    options.growth = 2 * h;
    return options;
  }

  void fill(const TopologyRepair& repair) {
    if (part_) whole_.take_seeds(*part_);
    std::vector<Ball> places;
    for (const std::uint32_t b : repair.changed) {
      places.push_back(repair.places[b]);
      points_.push_back(repair.places[b].center);
    }
    whole_.result.filled = BallIndex(repair.places);
    whole_.fill_gaps(places);
    spend(0.3, whole_);
    if (part_) part_ = whole_.part_around(points_);
  }

  Tessellator& whole_;
  bool unresolved_;                    ///< too much of the solid to fill its gaps: balls make it simpler
  std::unique_ptr<Tessellator> part_;  ///< none: rounds are those of the whole
  std::vector<Vec3> points_;           ///< that the part lies around
  double work_left_ = 0;               ///< samples
};

}  // namespace

bool fill_unresolved(Tessellator& state) {
  // What is missing altogether cannot be filled.
  return !state.result.sampling.unresolvable() && is_unresolved(state) && state.fill_narrow_gaps();
}

void repair_solid(Tessellator& state) {
  SolidRepair(state).run();
}

}  // namespace evenmesh
