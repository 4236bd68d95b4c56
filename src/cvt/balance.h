#pragma once
/// Seeds in balance: the whole schedule from samples to a converged CVT.

#include "cvt/optimize.h"

namespace evenmesh {

enum class SeedStart { random, blue_noise, coarse_to_fine };

struct BalanceOptions {
  SeedStart start = SeedStart::coarse_to_fine;
  bool lloyd = false;
  std::size_t evaluations = 20;         ///< of the energy on the finest level, at most
  std::size_t coarsest_evaluations = 40;  ///< on the coarsest level
  std::size_t coarse_evaluations = 24;  ///< on the levels between
  std::size_t annealing_rounds = 0;     ///< on the coarsest level
  double tolerance = 1e-4;              ///< see OptimizeOptions
  std::uint64_t seed = 1;
};

struct BalanceResult {
  std::vector<Vec3> seeds;
  std::vector<double> ratios;           ///< energy ratio of every evaluation, all levels in turn
  double energy_ratio = 0;              ///< of the seeds returned, on the samples given
};

/// Spreads `count` seeds evenly over a sampled surface by minimizing the CVT energy.
///
/// Coarse to fine: a few hundred seeds are balanced on a thinned sample set, then every two neighbours get a new seed
/// between them, which is balanced in turn, until there are `count`. Splitting continues a hexagonal pattern, so the number
/// of irregular vertices stays that of the coarsest level, where balancing costs almost nothing.
///
/// @param evaluator  of the sampled surface
/// Guarantee: exactly `count` seeds; same bits for any number of threads. Cost: about 1.4 · evaluations · samples.
/// @throws InvalidInput  if count < 4 or there are fewer samples than seeds
BalanceResult balance_seeds(CellEvaluator& evaluator, std::size_t count, const BalanceOptions& options, Run& run);

}  // namespace evenmesh
