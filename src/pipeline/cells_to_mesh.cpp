#include "pipeline/cells_to_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "connect/pinches.h"
#include "connect/surface_parts.h"
#include "cvt/starts.h"
#include "pipeline/fineness.h"
#include "pipeline/mend.h"

namespace evenmesh {
namespace {

constexpr int count_rounds = 3;      ///< attempts to meet the vertex count
constexpr int seed_rounds = 12;      ///< attempts to make every cell a disk with more seeds
constexpr int topology_rounds = 40;  ///< attempts altogether
constexpr int trim_rounds = 5;       ///< attempts to meet the vertex count in the end
constexpr int trim_seed_rounds = 3;  ///< after each of them
constexpr std::size_t settling_evaluations = 5;

BalanceOptions balance_options(const MeshOptions& options) {
  BalanceOptions balance;
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

class Cells {
 public:
  Cells(SampleSet& samples, std::size_t count, const MeshOptions& options, Stages& stages, Report& report, Run& run)
      : samples_(samples), count_(count), options_(options), stages_(stages), report_(report), run_(run), evaluator_(make_evaluator()) {}

  ConnectedCells result() {
    balance(count_);
    connect();
    clear_dust();
    meet_count();
    mend();
    trim_count();
    const bool two_manifold = !needs_seeds();
    return {std::move(seeds_), std::move(labels_), std::move(complex_.triangles), two_manifold, std::move(balls_)};
  }

 private:
  std::unique_ptr<CellEvaluator> make_evaluator() { return std::make_unique<CellEvaluator>(samples_, run_); }

  void balance(std::size_t count) {
    stages_.stage("balance", 0.6, [&] {
      BalanceResult result = balance_seeds(*evaluator_, count, balance_options(options_), run_);
      seeds_ = std::move(result.seeds);
      report_.energies.insert(report_.energies.end(), result.ratios.begin(), result.ratios.end());
      report_.energy_ratio = result.energy_ratio;
    });
  }

  void settle(std::size_t effort = 1) {
    stages_.stage("balance", 0, [&] {
      const auto result = optimize(*evaluator_, seeds_, {options_.optimizer == Optimizer::lloyd, effort * settling_evaluations, options_.tolerance}, run_);
      report_.energies.insert(report_.energies.end(), result.ratios.begin(), result.ratios.end());
    });
  }

  void connect() {
    stages_.stage("connect", 0.1, [&] {
      evaluator_->nearest(seeds_, labels_);
      complex_ = connect_labels(samples_, labels_, seeds_, run_);
      for (const CellPiece& piece : complex_.pieces) seeds_.push_back(piece.centroid);
    });
  }

  /// Back to the seeds before connect(): it would split their cells again, and those of the pieces with them.
  void forget_pieces() {
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

  /// Pieces of surface smaller than a cell cannot be meshed at this fineness; looked for only where cells stay unconnected.
  bool clear_dust() {
    if (unconnected().empty()) return false;
    std::size_t dropped = 0;
    stages_.stage("connect", 0, [&] {
      dropped = drop_dust(samples_, samples_.total_area / static_cast<double>(count_), run_);
      if (dropped > 0) evaluator_ = make_evaluator();
    });
    if (dropped == 0) return false;
    report_.dropped_components += dropped;
    if (samples_.size() < count_) throw UnusableInput("the surface consists of specks smaller than a cell: ask for more vertices");
    adjust_and_settle(std::max(count_, std::min(seeds_.size(), 2 * count_)));
    connect();
    return true;
  }

  void adjust_and_settle(std::size_t count) {
    stages_.stage("balance", 0, [&] { adjust_count(*evaluator_, seeds_, count, options_.seed + 7, run_); });
    settle();
  }

  /// Where thin walls split cells in two there are more labels than seeds: start again with fewer.
  void meet_count() {
    for (int round = 0; round < count_rounds; ++round) {
      const double made = static_cast<double>(complex_.labels), wanted = static_cast<double>(count_);
      if (made <= 1.001 * wanted) return;
      const double seeds = made - static_cast<double>(complex_.pieces.size());
      const auto fewer = static_cast<std::size_t>(std::max(4.0, std::round(seeds * wanted / made)));
      if (made > 1.1 * wanted) {
        balance(fewer);
      } else {
        forget_pieces();
        const std::size_t given = seeds_.size();
        adjust_and_settle(std::min(given, std::max<std::size_t>(4, given - static_cast<std::size_t>(made - wanted))));
      }
      connect();
    }
  }

  bool needs_seeds() const { return !complex_.defects.empty() || !unconnected().empty(); }

  /// Seeds, and balls where seeds cannot help, until all cells fit together.
  void mend() {
    const double edge = edge_length_of(samples_.total_area, static_cast<double>(count_));
    std::vector<Vec3> pinches;
    bool dust_cleared = false, pinches_known = false;
    for (int round = 0; round < topology_rounds && needs_seeds(); ++round) {
      if (!pinches_known) pinches = stages_.stage("connect", 0, [&] { return find_pinches(samples_, run_); }), pinches_known = true;
      auto defects = complex_.defects;
      for (const std::uint32_t l : unconnected()) defects.push_back({l, l});
      const Mending mending = stages_.stage("connect", 0, [&] {
        return plan_mending(samples_, labels_, seeds_, defects, pinches, balls_, {edge, round >= seed_rounds});
      });
      forget_pieces();
      seeds_.insert(seeds_.end(), mending.seeds.begin(), mending.seeds.end());
      report_.inserted_seeds += mending.seeds.size();
      if (!mending.changed.empty()) {
        balls_ = BallIndex(mending.balls);
        regularize(mending.changed, edge);
        pinches_known = false;
      }
      settle();
      connect();
      if ((!dust_cleared || !mending.changed.empty()) && !unconnected().empty()) {
        dust_cleared = true;
        if (clear_dust()) pinches_known = false;
      }
    }
  }

  /// Unites the changed balls with the solid.
  void regularize(std::span<const std::uint32_t> changed, double edge) {
    stages_.stage("regularize", 0, [&] {
      std::vector<Ball> balls;
      for (const std::uint32_t b : changed) balls.push_back(balls_.balls()[b]);
      samples_ = unite_balls(samples_, balls, run_);
      evaluator_ = make_evaluator();
      clear_around(seeds_, balls_, changed, edge);
      if (seeds_.size() < count_) adjust_count(*evaluator_, seeds_, count_, options_.seed + 11, run_);
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
    for (int attempt = 0; attempt < trim_rounds; ++attempt) {
      const auto excess = static_cast<std::int64_t>(vertices()) - static_cast<std::int64_t>(count_);
      if (std::abs(excess) * 1000 <= static_cast<std::int64_t>(count_)) return;
      auto seeds = seeds_;
      auto labels = labels_;
      auto complex = complex_;
      const auto change = std::max<std::size_t>(1, static_cast<std::size_t>(std::abs(excess)) >> attempt);
      stages_.stage("balance", 0, [&] {
        forget_pieces();
        if (excess > 0)
          remove_common_cells(samples_, seeds_, labels_, change);
        else
          adjust_count(*evaluator_, seeds_, seeds_.size() + change, options_.seed + 13, run_);
      });
      settle(2);
      connect();
      for (int round = 0; round < trim_seed_rounds && needs_seeds() && add_seeds_only(); ++round) {
        settle();
        connect();
      }
      const auto left = static_cast<std::int64_t>(vertices()) - static_cast<std::int64_t>(count_);
      if (needs_seeds() || std::abs(left) >= std::abs(excess))
        seeds_ = std::move(seeds), labels_ = std::move(labels), complex_ = std::move(complex);
    }
  }

  /// Mends by seeds; false when balls would be needed.
  bool add_seeds_only() {
    auto defects = complex_.defects;
    for (const std::uint32_t l : unconnected()) defects.push_back({l, l});
    const double edge = edge_length_of(samples_.total_area, static_cast<double>(count_));
    const Mending mending = plan_mending(samples_, labels_, seeds_, defects, {}, balls_, {edge, false});
    if (!mending.changed.empty()) return false;
    forget_pieces();
    seeds_.insert(seeds_.end(), mending.seeds.begin(), mending.seeds.end());
    return true;
  }

  SampleSet& samples_;
  std::size_t count_;
  const MeshOptions& options_;
  Stages& stages_;
  Report& report_;
  Run& run_;
  std::unique_ptr<CellEvaluator> evaluator_;
  std::vector<Vec3> seeds_;
  std::vector<std::uint32_t> labels_;
  LabelComplex complex_;
  BallIndex balls_{{}};
};

}  // namespace

ConnectedCells balance_and_connect(SampleSet& samples, std::size_t count, const MeshOptions& options, Stages& stages, Report& report,
                                   Run& run) {
  return Cells(samples, count, options, stages, report, run).result();
}

}  // namespace evenmesh
