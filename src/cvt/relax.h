#pragma once
/// Seeds in balance: the whole schedule from samples to a converged CVT.

#include <functional>
#include <optional>

#include "cvt/optimize.h"

namespace evenmesh {

enum class SeedStart { random, blue_noise, coarse_to_fine };

struct RelaxOptions {
  SeedStart start = SeedStart::coarse_to_fine;
  bool lloyd = false;
  double effort = 1;                       ///< scales the number of evaluations on every level, > 0
  std::optional<std::size_t> evaluations;  ///< of the energy on every level, instead
  std::size_t annealing_rounds = 0;        ///< on the coarsest level
  double tolerance = 1e-4;                 ///< see OptimizeOptions
  std::uint64_t seed = 1;
  /// Seeds that stay where they are, when there are so many altogether; none: all move.
  std::function<Seeds(std::size_t count)> fixed{};
};

struct RelaxResult {
  Seeds seeds;
  std::vector<double> ratios;  ///< energy ratio of every evaluation, all levels in turn
  double energy_ratio = 0;     ///< of the seeds returned, on the samples given
};

/// Spreads `count` seeds evenly over a sampled surface by minimizing the CVT energy.
///
/// Coarse to fine: a few hundred seeds are balanced on a thinned sample set, then every two neighbours get a new seed
/// between them, which is balanced in turn, until there are `count`. Splitting continues a hexagonal pattern, so the
/// number of irregular vertices stays that of the coarsest level, where balancing costs almost nothing.
///
/// @param evaluator  of the sampled surface
/// Guarantee: exactly `count` seeds; same bits for any number of threads. Cost: 10 to 30 evaluations of all samples.
/// @throws InvalidInput  if count < 4 or there are fewer samples than seeds
RelaxResult relax_seeds(CellEvaluator& evaluator, std::size_t count, const RelaxOptions& options,
                        ExecutionContext& context);

}  // namespace evenmesh
