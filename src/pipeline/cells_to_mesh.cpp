#include "pipeline/cells_to_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "connect/surface_parts.h"
#include "cvt/starts.h"

namespace evenmesh {
namespace {

constexpr int count_rounds = 3;      ///< attempts to meet the vertex count
constexpr int topology_rounds = 20;  ///< attempts to make every cell a disk
constexpr std::size_t settling_evaluations = 5;

BalanceOptions balance_options(const MeshOptions& options) {
  BalanceOptions balance;
  balance.start = options.start == Start::random       ? SeedStart::random
                  : options.start == Start::blue_noise ? SeedStart::blue_noise
                                                       : SeedStart::coarse_to_fine;
  balance.lloyd = options.optimizer == Optimizer::lloyd;
  balance.tolerance = options.tolerance;
  balance.seed = options.seed;
  const bool one_level = options.start != Start::coarse_to_fine;
  switch (options.quality) {
    case Quality::fast:
      balance.evaluations = one_level ? 40 : 8, balance.coarse_evaluations = 16, balance.coarsest_evaluations = 30;
      break;
    case Quality::normal:
      balance.evaluations = one_level ? 100 : 16;
      break;
    case Quality::high:
      balance.evaluations = one_level ? 300 : 80, balance.coarse_evaluations = 100, balance.coarsest_evaluations = 100, balance.annealing_rounds = 12;
      break;
  }
  if (options.iterations) balance.evaluations = balance.coarse_evaluations = balance.coarsest_evaluations = *options.iterations;
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
    bool dust_cleared_again = false;
    for (int round = 0; round < topology_rounds && needs_seeds(); ++round) {
      insert_seeds();
      connect();
      if (!dust_cleared_again && !unconnected().empty()) dust_cleared_again = true, clear_dust();
    }
    const bool two_manifold = !needs_seeds();
    return {std::move(seeds_), std::move(labels_), std::move(complex_.triangles), two_manifold};
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

  void settle() {
    stages_.stage("balance", 0, [&] {
      const auto result = optimize(*evaluator_, seeds_, {options_.optimizer == Optimizer::lloyd, settling_evaluations, options_.tolerance}, run_);
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
  void clear_dust() {
    if (unconnected().empty()) return;
    std::size_t dropped = 0;
    stages_.stage("connect", 0, [&] {
      dropped = drop_dust(samples_, samples_.total_area / static_cast<double>(count_), run_);
      if (dropped > 0) evaluator_ = make_evaluator();
    });
    if (dropped == 0) return;
    report_.dropped_components += dropped;
    if (samples_.size() < count_) throw UnusableInput("the surface consists of specks smaller than a cell: ask for more vertices");
    adjust_and_settle(count_);
    connect();
  }

  void adjust_and_settle(std::size_t count) {
    stages_.stage("balance", 0, [&] { adjust_count(*evaluator_, seeds_, count, options_.seed + 7, run_); });
    settle();
  }

  /// Where thin walls split cells in two there are more labels than seeds: start again with fewer.
  void meet_count() {
    for (int round = 0; round < count_rounds; ++round) {
      const double made = static_cast<double>(complex_.labels), wanted = static_cast<double>(count_);
      if (made <= 1.003 * wanted) return;
      const double seeds = made - static_cast<double>(complex_.pieces.size());
      const auto fewer = static_cast<std::size_t>(std::max(4.0, std::round(seeds * wanted / made)));
      if (made > 1.1 * wanted) {
        balance(fewer);
      } else {
        const std::size_t given = seeds_.size() - complex_.pieces.size();
        seeds_.resize(given);
        adjust_and_settle(std::min(given, std::max<std::size_t>(4, given - static_cast<std::size_t>(made - wanted))));
      }
      connect();
    }
  }

  bool needs_seeds() const { return !complex_.defects.empty() || !unconnected().empty(); }

  /// A seed at the sample farthest from the seed of each cell that is no disk, or meets another cell twice.
  void insert_seeds() {
    stages_.stage("connect", 0, [&] {
      std::vector<double> farthest(seeds_.size(), -1);
      std::vector<Vec3> place(seeds_.size());
      for (const std::uint32_t l : complex_.defects) farthest[l] = 0;
      for (const std::uint32_t l : unconnected()) farthest[l] = 0;
      for (const SampleBlock& block : samples_.blocks) {
        const Vec3 center = samples_.block_center(block);
        for (std::uint32_t i = block.begin; i < block.end; ++i) {
          const std::uint32_t l = labels_[i];
          if (farthest[l] < 0) continue;
          const Vec3 p = center + Vec3{samples_.x[i], samples_.y[i], samples_.z[i]};
          const double distance = squared_norm(p - seeds_[l]);
          if (distance > farthest[l]) farthest[l] = distance, place[l] = p;
        }
      }
      const std::size_t before = seeds_.size();
      for (std::size_t l = 0; l < before; ++l)
        if (farthest[l] > 0) seeds_.push_back(place[l]);
      report_.inserted_seeds += seeds_.size() - before;
    });
    settle();
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
};

}  // namespace

ConnectedCells balance_and_connect(SampleSet& samples, std::size_t count, const MeshOptions& options, Stages& stages, Report& report,
                                   Run& run) {
  return Cells(samples, count, options, stages, report, run).result();
}

}  // namespace evenmesh
