#include "pipeline/cells_to_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "connect/flood.h"
#include "connect/fragments.h"
#include "cvt/starts.h"
#include "features/crowding.h"
#include "grid/surface_components.h"
#include "pipeline/plan.h"
#include "topology/ambiguous_faces.h"
#include "topology/regularize.h"
#include "topology/repair.h"

namespace evenmesh {

RelaxOptions relax_options(const MeshOptions& options) {
  RelaxOptions balance;
  balance.start = options.start == Start::random       ? SeedStart::random
                  : options.start == Start::blue_noise ? SeedStart::blue_noise
                                                       : SeedStart::coarse_to_fine;
  balance.lloyd = options.optimizer == Optimizer::lloyd;
  balance.tolerance = options.tolerance;
  balance.seed = options.seed;
  balance.effort = options.quality == Quality::fast ? 0.5 : options.quality == Quality::high ? 3 : 1;
  balance.annealing_rounds = options.quality == Quality::high ? 12 : 0;
  balance.evaluations = options.iterations;
  return balance;
}

void report_cycles(const LabelComplex& complex, Report& report, ExecutionContext& context) {
  const auto& edges = complex.edges_by_cycle;
  const auto all = static_cast<double>(std::accumulate(edges.begin(), edges.end(), std::size_t{0}));
  report.cycle_shares.clear();
  for (std::size_t c = 0; c < edges.size(); ++c) {
    const double share = all > 0 ? static_cast<double>(edges[c]) / all : 0;
    report.cycle_shares.push_back(share);
    context.log(fmt::format("edges from cycles of {}: {}, {:.2f} %", c + 3, edges[c], 100 * share));
  }
}

namespace {

constexpr int count_rounds = 3;          ///< attempts to meet the vertex count
constexpr int seed_rounds = 12;          ///< attempts to make every cell a disk with more seeds
constexpr int patience = 3;              ///< rounds without a fifth fewer defects until seeds are given up
constexpr int ball_rounds = 32;          ///< those, and attempts to change the topology where it resists
constexpr int topology_rounds = 50;      ///< attempts altogether; the last ones divide cells down to single samples
constexpr int simplifying_rounds = 100;  ///< a ball grows up in ten of them
constexpr int releasing_from = 12;       ///< from here on without creases there
constexpr int perturbing_from = 5;       ///< round from which on every other one tries other seeds instead
constexpr int trim_rounds = 6;           ///< attempts to meet the vertex count in the end
constexpr int trim_seed_rounds = 3;      ///< after each of them
constexpr std::size_t relaxing_evaluations = 5;

class Cells {
 public:
  Cells(SampleSet& samples, std::size_t count, const MeshOptions& options, StageTimer& timer, Report& report,
        ExecutionContext& context)
      : samples_(samples),
        count_(count),
        options_(options),
        timer_(timer),
        report_(report),
        context_(context),
        evaluator_(make_evaluator()) {}

  ConnectedCells result() {
    find_sharp_edges();
    balance(count_);
    connect();
    clear_small_components();
    meet_count();
    if (options_.topology == TopologyRule::simplify)
      simplify();
    else
      repair_topology();
    trim_count();
    const bool two_manifold = !needs_seeds();
    report_cycles(complex_, report_, context_);
    return {.seeds = std::move(seeds_),
            .labels = std::move(labels_),
            .triangles = std::move(complex_.triangles),
            .two_manifold = two_manifold,
            .features = std::move(features_),
            .feature_seeds = std::move(feature_seeds_),
            .balls = std::move(balls_)};
  }

 private:
  std::unique_ptr<CellEvaluator> make_evaluator() { return std::make_unique<CellEvaluator>(samples_, context_); }

  /// Where seeds are held so that the mesh gets an edge there.
  void find_sharp_edges() {
    if (!options_.feature_angle || options_.wrap) return;
    timer_.stage("creases", 0.01, [&] {
      feature_edge_ = edge_length_of(samples_.total_area, static_cast<double>(count_));
      features_ = find_feature_curves(samples_, *options_.feature_angle, feature_edge_, context_);
      feature_seeds_ = place_feature_seeds(features_, feature_edge_);
    });
    context_.log(fmt::format("creases: {} chains, {} corners, {} seeds", features_.curves.size(),
                             features_.corners.size(), fixed()));
    // A web of creases as fine as the mesh, or one around places that were settled by vote, is noise.
    constexpr std::size_t many_corners = 100;
    const bool web = features_.corners.size() > many_corners && 2 * features_.corners.size() > fixed();
    const bool by_vote = 10 * samples_.disagreements > samples_.size();
    if (web || by_vote || 2 * fixed() > count_) {
      if (!by_vote)
        report_.notices.push_back({false,
                                   "there are too many sharp edges for meshes this coarse to follow, and none is "
                                   "held: ask for more vertices"});
      features_ = {}, feature_seeds_ = {};
    }
    for (const FeatureCurve& curve : features_.curves)
      for (std::size_t p = 1; p < curve.points.size(); ++p)
        report_.crease_length += norm(curve.points[p] - curve.points[p - 1]);
    report_.crease_vertices = fixed();
  }
  std::size_t fixed() const { return feature_seeds_.places.size(); }

  void balance(std::size_t count) {
    timer_.stage("balance", 0.6, [&] {
      RelaxOptions balance = relax_options(options_);
      if (fixed() > 0)
        balance.fixed = [&](std::size_t seeds) {
          if (2 * seeds > count) return feature_seeds_.places;
          return place_feature_seeds(features_, edge_length_of(samples_.total_area, double(seeds))).places;
        };
      RelaxResult result = relax_seeds(*evaluator_, count, balance, context_);
      seeds_ = std::move(result.seeds);
      report_.energies.insert(report_.energies.end(), result.ratios.begin(), result.ratios.end());
      report_.energy_ratio = result.energy_ratio;
    });
  }

  void relax(std::size_t effort = 1) {
    timer_.stage("balance", 0, [&] {
      const auto result =
          optimize(*evaluator_, seeds_,
                   {options_.optimizer == Optimizer::lloyd, effort * relaxing_evaluations, options_.tolerance, fixed()},
                   context_);
      report_.energies.insert(report_.energies.end(), result.ratios.begin(), result.ratios.end());
    });
  }

  void connect() {
    timer_.stage("connect", 0.1, [&] {
      evaluator_->nearest(seeds_, labels_);
      if (options_.connect == Connect::fragments) {
        complex_ = connect_fragments(samples_, seeds_, {.max_cycle = options_.max_cycle}, context_).complex;
        return;
      }
      if (options_.connect == Connect::flood) flood_labels(samples_, labels_, seeds_, context_);
      if (fixed() > 0) constrain_labels(samples_, features_, feature_seeds_, labels_, context_);
      complex_ = connect_labels(samples_, labels_, seeds_, context_, fixed());
      for (const CellComponent& piece : complex_.pieces) seeds_.push_back(piece.centroid);
    });
  }

  /// Back to the seeds before connect(): it would split their cells again, and those of the pieces with them.
  void forget_split_cells() {
    seeds_.resize(seeds_.size() - complex_.pieces.size());
    complex_.pieces.clear();
  }

  /// Labels that own samples but no triangle.
  std::vector<std::uint32_t> unconnected() const {
    std::vector<char> state(seeds_.size(), 0);
    for (const std::uint32_t l : labels_) state[l] = 1;
    for (const Triangle& t : complex_.triangles)
      for (const std::uint32_t l : t) state[l] = 2;
    std::vector<std::uint32_t> list;
    for (std::uint32_t l = 0; l < state.size(); ++l)
      if (state[l] == 1) list.push_back(l);
    return list;
  }

  /// Pieces of surface smaller than a cell cannot be meshed at this fineness; looked for only where cells stay
  /// unconnected.
  bool clear_small_components() {
    if (unconnected().empty()) return false;
    std::size_t dropped = 0;
    timer_.stage("connect", 0, [&] {
      const double cell = samples_.total_area / static_cast<double>(count_);
      RemainingSurface rest = drop_small_components(std::move(samples_), cell, context_);
      samples_ = std::move(rest.samples);
      dropped = rest.dropped;
      if (dropped > 0) evaluator_ = make_evaluator();
    });
    if (dropped == 0) return false;
    report_.dropped_components += dropped;
    if (samples_.size() < count_)
      throw UnusableInput("the surface consists of specks smaller than a cell: ask for more vertices");
    refill_idle_seeds();
    relax();
    connect();
    return true;
  }

  /// Seeds whose samples have gone start again elsewhere.
  void refill_idle_seeds() {
    timer_.stage("balance", 0, [&] {
      forget_split_cells();
      const std::size_t given = std::min(seeds_.size(), count_);
      evaluator_->nearest(seeds_, labels_);
      std::vector<char> owns(seeds_.size(), 0);
      for (const std::uint32_t l : labels_) owns[l] = 1;
      std::size_t kept = 0;
      for (std::size_t s = 0; s < seeds_.size(); ++s)
        if (owns[s] || s < fixed()) seeds_[kept++] = seeds_[s];
      seeds_.resize(kept);
      if (kept < given) adjust_count(*evaluator_, seeds_, given, options_.seed + 7, context_, fixed());
    });
  }

  void adjust_and_relax(std::size_t count) {
    timer_.stage("balance", 0, [&] { adjust_count(*evaluator_, seeds_, count, options_.seed + 7, context_, fixed()); });
    relax();
  }

  /// Where thin walls split cells in two there are more labels than seeds: start again with fewer.
  void meet_count() {
    for (int round = 0; round < count_rounds; ++round) {
      const double made = static_cast<double>(complex_.labels), wanted = static_cast<double>(count_);
      if (made <= 1.001 * wanted) return;
      const double seeds = made - static_cast<double>(complex_.pieces.size());
      const auto fewer = static_cast<std::size_t>(std::max(4.0 + double(fixed()), std::round(seeds * wanted / made)));
      if (made > 1.1 * wanted) {
        balance(fewer);
      } else {
        forget_split_cells();
        const std::size_t given = seeds_.size();
        adjust_and_relax(
            std::min(given, std::max<std::size_t>(4 + fixed(), given - static_cast<std::size_t>(made - wanted))));
      }
      connect();
    }
  }

  bool needs_seeds() const { return !complex_.defects.empty() || !unconnected().empty(); }

  /// Length of the mesh's edges, as many cells as there are now.
  double edge() const {
    return edge_length_of(samples_.total_area, static_cast<double>(std::max({count_, seeds_.size(), complex_.labels})));
  }

  /// Labels with a defect, and those that got no triangle.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> defects() const {
    auto list = complex_.defects;
    for (const std::uint32_t l : unconnected()) list.push_back({l, l});
    return list;
  }

  TopologyRepair plan(std::span<const Vec3> ambiguous_faces, TopologyRepairOptions options) {
    return timer_.stage("connect", 0, [&] {
      options.edge = edge();
      options.given = seeds_.size() - complex_.pieces.size();
      return plan_topology_repair(samples_, labels_, seeds_, defects(), ambiguous_faces, balls_, options);
    });
  }

  /// Seeds, and balls where seeds cannot help, until all cells fit together.
  void repair_topology() {
    std::vector<Vec3> ambiguous_faces;
    bool small_components_cleared = false, ambiguous_faces_known = false;
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    int idle_rounds = 0;
    for (int round = 0; round < topology_rounds && needs_seeds(); ++round) {
      const std::size_t found = defects().size();
      idle_rounds = 10 * found < 8 * fewest ? 0 : idle_rounds + 1;
      fewest = std::min(fewest, found);
      if (!ambiguous_faces_known)
        ambiguous_faces = timer_.stage("connect", 0, [&] { return find_ambiguous_faces(samples_, context_); }),
        ambiguous_faces_known = true;
      context_.log(fmt::format("mend {}: {} defects, {} seeds, {} balls, {} pinches", round, found, seeds_.size(),
                               balls_.balls().size(), ambiguous_faces.size()));
      const bool last_resort = round >= ball_rounds, seeds_are_idle = round >= seed_rounds || idle_rounds >= patience;
      if (seeds_are_idle) idle_rounds = patience;
      const TopologyRepair repair = plan(ambiguous_faces, {.prefer_balls = seeds_are_idle, .seeds_only = last_resort});
      forget_split_cells();
      seeds_.insert(seeds_.end(), repair.seeds.begin(), repair.seeds.end());
      report_.inserted_seeds += repair.seeds.size();
      if (!repair.changed.empty()) {
        balls_ = BallIndex(repair.balls);
        regularize(repair.changed);
        ambiguous_faces_known = false;
      }
      // Balance would draw seeds out of the narrow places they have been put into.
      if (!last_resort && (!seeds_are_idle || !repair.changed.empty())) relax();
      connect();
      if ((!small_components_cleared || !repair.changed.empty()) && !unconnected().empty()) {
        small_components_cleared = true;
        if (clear_small_components()) ambiguous_faces_known = false;
      }
    }
  }

  /// The paper's loop: the topology gives way, not the number of vertices. [Raster2Mesh §4.4]
  void simplify() {
    RegularizationBalls list(samples_.grid.spacing, edge());
    for (int round = 0; round < simplifying_rounds && needs_seeds(); ++round) {
      std::vector<BadEdge> edges;
      for (const auto& [a, b] : defects()) edges.push_back({seeds_[a], seeds_[b]});
      if (round >= perturbing_from && round % 2 != 0) {
        if (round >= releasing_from) release_features();
        perturb(static_cast<std::uint64_t>(round));
        continue;
      }
      const std::vector<std::uint32_t> changed = list.next_round(edges);
      context_.log(fmt::format("simplify {}: {} places, {} seeds, {} balls, {} new or grown", round, edges.size(),
                               seeds_.size(), list.balls().size(), changed.size()));
      const std::size_t pieces = complex_.pieces.size();
      forget_split_cells();
      // Pieces of cells count as vertices too.
      if (const std::size_t room = std::max<std::size_t>(4, count_ - std::min(pieces, count_)); seeds_.size() > room)
        timer_.stage("balance", 0, [&] { adjust_count(*evaluator_, seeds_, room, options_.seed + 7, context_); });
      balls_ = BallIndex(list.balls());
      regularize(changed);
      relax();
      connect();
      if (!unconnected().empty()) clear_small_components();
    }
  }

  /// Other seeds where some do not get along, however large the balls are.
  void perturb(std::uint64_t round) {
    std::vector<char> bad(seeds_.size(), 0);
    for (const auto& [a, b] : defects()) bad[std::max(a, b)] = 1;
    const std::size_t given = seeds_.size() - complex_.pieces.size();
    std::vector<Vec3> kept;
    for (std::size_t s = 0; s < given; ++s)
      if (!bad[s] || s < fixed()) kept.push_back(seeds_[s]);
    seeds_ = std::move(kept);
    timer_.stage("balance", 0,
                 [&] { adjust_count(*evaluator_, seeds_, given, options_.seed + round, context_, fixed()); });
    relax();
    connect();
  }

  /// Gives up the chains whose seeds do not get along; the other seeds of these are free now.
  void release_features() {
    std::vector<char> bad(seeds_.size(), 0);
    for (const auto& [a, b] : defects()) bad[a] = bad[b] = 1;
    const FeatureSeeds old = std::move(feature_seeds_);
    std::vector<char> doomed(features_.curves.size(), 0);
    for (std::size_t s = old.corners; s < old.places.size(); ++s)
      if (bad[s]) doomed[old.curve_of(s)] = 1;
    for (std::size_t c = 0; c < doomed.size(); ++c)
      for (const std::uint32_t corner : {features_.curves[c].from, features_.curves[c].to})
        if (corner != FeatureCurve::none && bad[corner]) doomed[c] = 1;
    features_ = without_curves(features_, doomed);
    feature_seeds_ = place_feature_seeds(features_, feature_edge_);
    forget_split_cells();
    std::set<std::array<double, 3>> stay;
    for (const Vec3& p : feature_seeds_.places) stay.insert({p.x, p.y, p.z});
    std::vector<Vec3> seeds = feature_seeds_.places;
    for (std::size_t s = 0; s < seeds_.size(); ++s)
      if (s >= old.places.size() || !stay.contains({seeds_[s].x, seeds_[s].y, seeds_[s].z})) seeds.push_back(seeds_[s]);
    seeds_ = std::move(seeds);
    connect();
  }

  /// Unites the changed balls with the solid.
  void regularize(std::span<const std::uint32_t> changed) {
    timer_.stage("regularize", 0, [&] {
      std::vector<Ball> balls;
      for (const std::uint32_t b : changed) balls.push_back(balls_.balls()[b]);
      const std::size_t given = std::min(seeds_.size(), count_);
      samples_ = unite_balls(samples_, balls, context_);
      evaluator_ = make_evaluator();
      std::vector<Vec3> others(seeds_.begin() + static_cast<std::ptrdiff_t>(fixed()), seeds_.end());
      clear_around(others, balls_, changed, edge());
      seeds_.resize(fixed());
      seeds_.insert(seeds_.end(), others.begin(), others.end());
      if (seeds_.size() < given) adjust_count(*evaluator_, seeds_, given, options_.seed + 11, context_, fixed());
      ++report_.regularization_rounds;
    });
  }

  /// Vertices the mesh will have.
  std::size_t vertices() const {
    std::vector<char> used(seeds_.size(), 0);
    for (const Triangle& t : complex_.triangles)
      for (const std::uint32_t l : t) used[l] = 1;
    return static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
  }

  /// Vertices too many or too few are corrected where the topology can do without them: among cells of common size.
  void trim_count() {
    if (needs_seeds()) return;
    const auto tolerance = static_cast<std::int64_t>(count_ / 1000);
    for (int attempt = 0, failures = 0; attempt < trim_rounds; ++attempt) {
      const std::size_t made = vertices();
      const auto excess = static_cast<std::int64_t>(made) - static_cast<std::int64_t>(count_);
      if (std::abs(excess) <= tolerance) return;
      auto seeds = seeds_;
      auto labels = labels_;
      auto complex = complex_;
      forget_split_cells();
      const std::size_t change = static_cast<std::size_t>(std::abs(excess)) * seeds_.size() / made >> failures;
      change_count(excess > 0, std::max<std::size_t>(1, change));
      const auto left = static_cast<std::int64_t>(vertices()) - static_cast<std::int64_t>(count_);
      if (!needs_seeds() && std::abs(left) < std::abs(excess)) continue;
      seeds_ = std::move(seeds), labels_ = std::move(labels), complex_ = std::move(complex);
      ++failures;
    }
  }

  /// Fewer seeds or more, and what these need to fit together; balls are not among that.
  void change_count(bool fewer, std::size_t change) {
    timer_.stage("balance", 0, [&] {
      if (fewer)
        remove_common_cells(samples_, seeds_, labels_, change, fixed());
      else
        adjust_count(*evaluator_, seeds_, seeds_.size() + change, options_.seed + 13, context_);
    });
    relax(2);
    connect();
    for (int round = 0; round < trim_seed_rounds && needs_seeds(); ++round) {
      const TopologyRepair repair = plan({}, {});
      if (!repair.changed.empty()) return;
      forget_split_cells();
      seeds_.insert(seeds_.end(), repair.seeds.begin(), repair.seeds.end());
      relax();
      connect();
    }
  }

  SampleSet& samples_;
  std::size_t count_;
  const MeshOptions& options_;
  StageTimer& timer_;
  Report& report_;
  ExecutionContext& context_;
  std::unique_ptr<CellEvaluator> evaluator_;
  std::vector<Vec3> seeds_;
  std::vector<std::uint32_t> labels_;
  LabelComplex complex_;
  FeatureCurves features_;
  FeatureSeeds feature_seeds_;
  double feature_edge_ = 0;
  BallIndex balls_{{}};
};

}  // namespace

ConnectedCells relax_and_connect(SampleSet& samples, std::size_t count, const MeshOptions& options, StageTimer& timer,
                                 Report& report, ExecutionContext& context) {
  return Cells(samples, count, options, timer, report, context).result();
}

}  // namespace evenmesh
