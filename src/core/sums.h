#pragma once
/// Sums that do not depend on the number of threads: fixed pieces, added up in order.

#include <cstddef>
#include <vector>

#include "core/parallel.h"

namespace evenmesh {

/// Σ term(i) for i in [0, count); pieces of 4,096 terms are summed in parallel, then in order.
template <typename Term>
double ordered_sum(const ExecutionContext& context, std::size_t count, const Term& term) {
  constexpr std::size_t piece = 4096;
  std::vector<double> sums((count + piece - 1) / piece);
  parallel_tasks(context, sums.size(), [&](std::size_t p) {
    double sum = 0;
    for (std::size_t i = p * piece; i < std::min(count, (p + 1) * piece); ++i) sum += term(i);
    sums[p] = sum;
  });
  double total = 0;
  for (const double s : sums) total += s;
  return total;
}

}  // namespace evenmesh
