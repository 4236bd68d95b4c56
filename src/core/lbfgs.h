#pragma once
/// What optimizers by L-BFGS share: vector arithmetic on many variables at once, and the approximate inverse Hessian.

#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/sums.h"

namespace evenmesh {

/// Vector arithmetic on all variables at once; same bits for any number of threads. `T` is a short vector: its dot(a,
/// b) gives a double, its +=, −=, *= are those of a vector space.
template <typename T>
class VariableAlgebra {
 public:
  explicit VariableAlgebra(ExecutionContext& context) : context_(context) {}
  double dot_all(const std::vector<T>& a, const std::vector<T>& b) const {
    return ordered_sum(context_, a.size(), [&](std::size_t i) { return dot(a[i], b[i]); });
  }
  template <typename Op>
  void each(std::size_t count, const Op& op) const {
    parallel_for(context_, count, 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) op(i);
    });
  }

 private:
  ExecutionContext& context_;
};

/// Limited-memory inverse Hessian, two-loop recursion (Nocedal, Updating quasi-Newton matrices with limited storage,
/// 1980), from the last five steps.
template <typename T>
class LimitedMemoryHessian {
 public:
  using Variables = std::vector<T>;

  /// Keeps a reference to `algebra`.
  explicit LimitedMemoryHessian(const VariableAlgebra<T>& algebra) : algebra_(algebra) {}
  bool empty() const { return pairs_.empty(); }
  void clear() { pairs_.clear(); }
  /// @param change  of the gradient over the step; without curvature along it the pair is left out
  void add(Variables step, Variables change) {
    const double curvature = algebra_.dot_all(step, change);
    if (!(curvature > 0)) return;
    if (pairs_.size() == length) pairs_.pop_front();
    pairs_.push_back({std::move(step), std::move(change), 1 / curvature});
  }
  /// −H·gradient, H starting from diag(inverse_diagonal) scaled to the last pair.
  Variables direction(const Variables& gradient, const std::vector<double>& inverse_diagonal) const {
    Variables q = gradient;
    std::vector<double> alpha(pairs_.size());
    for (std::size_t p = pairs_.size(); p-- > 0;) {
      const Pair& pair = pairs_[p];
      alpha[p] = pair.inverse_curvature * algebra_.dot_all(pair.step, q);
      algebra_.each(q.size(), [&](std::size_t i) { q[i] -= alpha[p] * pair.change[i]; });
    }
    double scale = 1;
    if (!pairs_.empty()) {
      const Pair& last = pairs_.back();
      Variables scaled(q.size());
      algebra_.each(q.size(), [&](std::size_t i) { scaled[i] = inverse_diagonal[i] * last.change[i]; });
      scale = 1 / (last.inverse_curvature * algebra_.dot_all(last.change, scaled));
    }
    algebra_.each(q.size(), [&](std::size_t i) { q[i] *= scale * inverse_diagonal[i]; });
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const Pair& pair = pairs_[p];
      const double beta = pair.inverse_curvature * algebra_.dot_all(pair.change, q);
      algebra_.each(q.size(), [&](std::size_t i) { q[i] += (alpha[p] - beta) * pair.step[i]; });
    }
    algebra_.each(q.size(), [&](std::size_t i) { q[i] *= -1.0; });
    return q;
  }

 private:
  static constexpr std::size_t length = 5;
  struct Pair {
    Variables step, change;
    double inverse_curvature;
  };
  const VariableAlgebra<T>& algebra_;
  std::deque<Pair> pairs_;
};

}  // namespace evenmesh
