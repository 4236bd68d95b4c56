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
constexpr double hopeless = 0.5;
constexpr int releasing_from = 6;   ///< sharp edges, where they do not fit however small the cells beside them are
constexpr int relaxing_rounds = 2;  ///< of all seeds there; then the new ones find their places alone
constexpr int seed_rounds = 12;     ///< attempts to make every cell a disk with more seeds
constexpr int patience = 3;         ///< rounds without a fifth fewer defects until seeds are given up
constexpr double work_limit = 16;   ///< rounds on as many samples as the surface has, altogether
constexpr double smallest_surface = 1e5;  ///< samples that such a round is counted as, at least
constexpr double seed_limit = 3;          ///< of the vertices asked for: what the topology may come to need
/// Defects per vertex and ambiguous faces per sample, above which the grid does not resolve the solid: all of these
/// faces are seen to at once. Some are at sharp edges and where surface just reaches a layer of the grid; those do no
/// harm, and there are no defects.
constexpr double torn = 0.01, crowded = 0.003;
constexpr double first_radius = 0.6;  ///< of places to be filled, in edges
constexpr double crowded_radius = 1;  ///< where the solid is not resolved
constexpr int filling_rounds = 4;

std::vector<Vec3> ambiguous_faces(Tessellator& state) {
  return state.timer.stage("connect", 0,
                           [&] { return find_ambiguous_faces(state.result.sampling.samples, state.context); });
}

class SolidRepair {
 public:
  explicit SolidRepair(Tessellator& whole) : whole_(whole), crowded_(!whole.result.filled.balls().empty()) {}

  void run() {
    if (whole_.result.sampling.unresolvable()) return;
    if (static_cast<double>(whole_.defects().size()) > hopeless * static_cast<double>(whole_.wanted()) + 10 * few)
      return;
    const SampleSet& samples = whole_.result.sampling.samples;
    work_left_ = work_limit * std::max(smallest_surface, static_cast<double>(samples.size()));
    for (int visit = 0; visit < visits && !whole_.fits() && !used_up(); ++visit) {
      visit_places(visit);
      spend(0.5, whole_);
      whole_.connect();
      if (fixed_seeds_are_in_the_way(whole_)) whole_.release_features();
      if (!whole_.unconnected().empty() && whole_.clear_small_components()) spend(1, whole_);
    }
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
          "repair {}.{}: {} defects, {} seeds, {} places filled, {} ambiguous faces; {} samples", visit, round, found,
          state().result.seeds.size(), whole_.result.filled.balls().size(), ambiguous.size(), size_of(state())));
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
    TopologyRepairOptions options{
        .prefer_places = prefer_places || crowded_, .unresolved = crowded_, .seeds_only = round >= dividing_from};
    options.seeds_per_cell = static_cast<std::size_t>(std::min(1 + round / 2, most_seeds_per_cell));
    options.first_radius = std::max(4 * h, (crowded_ ? crowded_radius : first_radius) * edge);
    options.growth = std::max(2 * h, 0.2 * edge);
    options.last_radius = std::max(options.first_radius, crowded_radius * edge);
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
  bool crowded_;                       ///< gaps had to be filled everywhere
  std::unique_ptr<Tessellator> part_;  ///< none: rounds are those of the whole
  std::vector<Vec3> points_;           ///< that the part lies around
  double work_left_ = 0;               ///< samples
};

}  // namespace

bool fill_unresolved(Tessellator& state) {
  Tessellation& cells = state.result;
  if (cells.sampling.unresolvable()) return false;  // what is missing cannot be filled
  if (static_cast<double>(state.defects().size()) <= torn * static_cast<double>(state.wanted()) + few) return false;
  const SampleSet& samples = cells.sampling.samples;
  for (int round = 0; round < filling_rounds; ++round) {
    const std::vector<Vec3> faces = ambiguous_faces(state);
    if (static_cast<double>(faces.size()) <= crowded * static_cast<double>(samples.size())) return round > 0;
    const double radius = std::max(4 * samples.grid.spacing, crowded_radius * state.edge()), apart = 0.5 * radius;
    BallIndex all(cells.filled.balls(), radius);
    std::vector<Ball> places;
    PointHash taken(apart);
    for (const Vec3& p : faces) {
      if (taken.near(p, apart, [](std::uint32_t) { return true; })) continue;
      taken.add(p);
      places.push_back({p, radius});
      all.add(places.back());
    }
    state.context.log(fmt::format("fill {}: {} ambiguous faces, {} places", round, faces.size(), places.size()));
    cells.filled = std::move(all);
    state.fill_gaps(places);
    state.drop_small_components();
  }
  return true;
}

void repair_solid(Tessellator& state) {
  SolidRepair(state).run();
}

}  // namespace evenmesh
