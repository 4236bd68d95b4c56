#include "cvt/relax.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "cvt/starts.h"
#include "grid/coarsen.h"

namespace evenmesh {
namespace {

constexpr std::size_t coarsest_seeds = 300;  ///< fewer cannot follow the shape; more leave more grain boundaries
constexpr double samples_per_seed = 80;      ///< wanted on every level
constexpr double clear_distance = 0.6;  ///< of others from seeds that are fixed, in edges, before they are balanced

/// The sample set and thinner and thinner versions of it, each with its evaluator.
class Pyramid {
 public:
  Pyramid(CellEvaluator& finest, double fewest_samples, ExecutionContext& context) : levels_{&finest} {
    while (static_cast<double>(levels_.back()->samples().size()) / 4 >= fewest_samples) {
      sets_.push_back(std::make_unique<SampleSet>(coarsen(levels_.back()->samples(), context)));
      evaluators_.push_back(finest.for_samples(*sets_.back(), context));
      levels_.push_back(evaluators_.back().get());
    }
  }
  /// The thinnest set with enough samples for `seeds` seeds.
  CellEvaluator& for_seeds(std::size_t seeds) {
    std::size_t level = levels_.size() - 1;
    while (level > 0 &&
           static_cast<double>(levels_[level]->samples().size()) < samples_per_seed * static_cast<double>(seeds))
      --level;
    return *levels_[level];
  }
  CellEvaluator& finest() { return *levels_[0]; }

 private:
  std::vector<CellEvaluator*> levels_;
  std::vector<std::unique_ptr<SampleSet>> sets_;
  std::vector<std::unique_ptr<CellEvaluator>> evaluators_;
};

class Relaxation {
 public:
  Relaxation(CellEvaluator& finest, std::size_t count, const RelaxOptions& options, ExecutionContext& context)
      : count_(count),
        options_(options),
        context_(context),
        levels_(count_levels()),
        pyramid_(finest, samples_per_seed * static_cast<double>(count_at(levels_)), context) {}

  RelaxResult result() {
    start();
    for (std::size_t level = levels_;; --level) {
      const bool finest = level == 0, coarsest = level == levels_;
      CellEvaluator& evaluator = finest ? pyramid_.finest() : pyramid_.for_seeds(seeds_.size());
      double energy = relax(evaluator, seeds_, evaluations(coarsest));
      if (coarsest && options_.annealing_rounds > 0) anneal(evaluator, energy);
      if (finest) break;
      split(count_at(level - 1));
    }
    CellSums sums;
    pyramid_.finest().evaluate(seeds_, sums);
    const double area = pyramid_.finest().samples().total_area;
    return {std::move(seeds_), std::move(ratios_), energy_ratio(sums.energy, count_, area)};
  }

 private:
  std::size_t count_levels() const {
    std::size_t levels = 0;
    if (options_.start == SeedStart::coarse_to_fine)
      while (count_at(levels + 1) >= coarsest_seeds) ++levels;
    return levels;
  }
  /// Seeds on a level; level 0 is the finest.
  std::size_t count_at(std::size_t level) const {
    std::size_t n = count_;
    for (; level > 0; --level) n = (n + 3) / 4;
    return n;
  }

  /// Seeds that were split from balanced ones need few evaluations, the fewer the smaller the share of irregular places
  /// among them; those that start anywhere need many.
  std::size_t evaluations(bool coarsest) const {
    if (options_.evaluations) return *options_.evaluations;
    const double few = std::clamp(30 * std::pow(4000.0 / static_cast<double>(seeds_.size()), 0.6), 6.0, 40.0);
    return static_cast<std::size_t>(std::lround(options_.effort * (!coarsest ? few : levels_ == 0 ? 100 : 40)));
  }

  void start() {
    const std::size_t n = count_at(levels_);
    const SampleSet& samples = pyramid_.for_seeds(n).samples();
    seeds_ = options_.start == SeedStart::random ? random_start(samples, n, options_.seed)
                                                 : blue_noise_start(samples, n, options_.seed);
    hold(n);
    adjust_count(pyramid_.for_seeds(n), seeds_, n, options_.seed + 4, context_);
  }

  /// Puts those seeds first that are to be fixed among n; not on coarse levels where they would leave no room for
  /// others.
  void hold(std::size_t n) {
    if (!options_.fixed) return;
    Seeds fixed = options_.fixed(n);
    if (2 * fixed.size() > n && n != count_) fixed = {};
    const double edge = std::sqrt(2 * pyramid_.finest().samples().total_area / (std::numbers::sqrt3 * double(n)));
    const std::vector<Vec3> others(seeds_.free_positions().begin(), seeds_.free_positions().end());
    seeds_ = fixed_and_others(std::move(fixed), others, clear_distance * edge);
  }

  double relax(CellEvaluator& evaluator, Seeds& seeds, std::size_t evaluations) {
    const auto result = optimize(evaluator, seeds, {options_.lloyd, evaluations, options_.tolerance}, context_);
    ratios_.insert(ratios_.end(), result.ratios.begin(), result.ratios.end());
    return result.energy;
  }

  /// Shakes all seeds by less and less and keeps what has less energy: melts grain boundaries of a local minimum.
  void anneal(CellEvaluator& evaluator, double best) {
    Random random(options_.seed + 1);
    const double spacing = std::sqrt(evaluator.samples().total_area / static_cast<double>(seeds_.size()));
    const auto rounds = static_cast<double>(options_.annealing_rounds);
    for (double round = 0; round < rounds; ++round) {
      const double amplitude = 0.25 * spacing * (1 - round / rounds);
      Seeds shaken = seeds_;
      for (std::size_t s = seeds_.fixed.size(); s < shaken.size(); ++s)
        shaken.positions[s] += amplitude * Vec3{random.gaussian(), random.gaussian(), random.gaussian()};
      const double energy = relax(evaluator, shaken, evaluations(true));
      if (energy < best) {
        best = energy;
        std::swap(seeds_, shaken);
      }
    }
  }

  /// Goes to the next finer level. The number of neighbour pairs depends on the shape's genus: where it matters, the
  /// coarse seeds are first made as many as will give `target`; the few that differ are added or removed on the finer
  /// level.
  void split(std::size_t target) {
    CellEvaluator& evaluator =
        pyramid_.for_seeds(target);  // four times as many samples as balancing needs: sees short borders
    std::vector<Vec3> middles = neighbour_middles(evaluator, seeds_.positions, context_);
    const auto now = static_cast<std::int64_t>(seeds_.size()), after = now + static_cast<std::int64_t>(middles.size());
    const std::int64_t change = (static_cast<std::int64_t>(target) - after) / 4;
    if (std::abs(change) * 100 > now) {
      adjust_count(evaluator, seeds_, static_cast<std::size_t>(std::max<std::int64_t>(4, now + change)),
                   options_.seed + 2, context_);
      relax(pyramid_.for_seeds(seeds_.size()), seeds_, evaluations(false) / 3);
      middles = neighbour_middles(evaluator, seeds_.positions, context_);
    }
    seeds_.positions.insert(seeds_.positions.end(), middles.begin(), middles.end());
    hold(target);
    adjust_count(evaluator, seeds_, target, options_.seed + 3, context_);
  }

  std::size_t count_;
  RelaxOptions options_;
  ExecutionContext& context_;
  std::size_t levels_;
  Pyramid pyramid_;
  Seeds seeds_;
  std::vector<double> ratios_;
};

}  // namespace

RelaxResult relax_seeds(CellEvaluator& evaluator, std::size_t count, const RelaxOptions& options,
                        ExecutionContext& context) {
  if (count < 4) throw InvalidInput("a closed mesh needs at least 4 vertices: ask for more");
  const SampleSet& samples = evaluator.samples();
  if (samples.size() < count)
    throw InvalidInput(
        fmt::format("{} vertices need more than {} samples: raise the resolution", count, samples.size()));
  return Relaxation(evaluator, count, options, context).result();
}

}  // namespace evenmesh
