#pragma once
/// Moves seeds to a (local) minimum of the CVT energy.

#include <functional>

#include "cvt/cells.h"
#include "grid/seeds.h"

namespace evenmesh {

struct OptimizeOptions {
  bool lloyd = false;              ///< Lloyd's iteration instead of L-BFGS
  std::size_t evaluations = 50;    ///< of the energy, at most
  double tolerance = 1e-4;         ///< stop when the mean step is below this share of the seed spacing √(A/k)
  std::span<const char> frozen{};  ///< by seed, besides the fixed ones: not 0 where it stays; may end early
};

struct OptimizeResult {
  double energy = 0;           ///< F at the seeds returned
  std::vector<double> ratios;  ///< energy ratio of every evaluation
};

/// Minimizes F over the positions of the free seeds; they may leave the surface a little (RCVT).
///
/// L-BFGS (Liu et al., On centroidal Voronoi tessellation, ToG 2009) with history 5, preconditioned by 1/(2 m_i), so
/// that its first step is Lloyd's; backtracking line search; Lloyd's step where the direction does not descend. Cost:
/// `evaluations` × CellEvaluator::evaluate. Same bits for any number of threads.
OptimizeResult optimize(CellEvaluator& evaluator, Seeds& seeds, const OptimizeOptions& options,
                        ExecutionContext& context);

}  // namespace evenmesh
