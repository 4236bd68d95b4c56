#include "cvt/optimize.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "core/sums.h"

namespace evenmesh {
namespace {

using Vectors = std::vector<Vec3>;

/// Vector arithmetic on all seeds at once.
class Algebra {
 public:
  explicit Algebra(ExecutionContext& context) : context_(context) {}
  double dot_all(const Vectors& a, const Vectors& b) const {
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

/// Limited-memory inverse Hessian, two-loop recursion (Nocedal 1980).
class History {
 public:
  explicit History(const Algebra& algebra) : algebra_(algebra) {}
  void clear() { pairs_.clear(); }
  void add(Vectors step, Vectors change) {
    const double curvature = algebra_.dot_all(step, change);
    if (!(curvature > 0)) return;
    if (pairs_.size() == length) pairs_.pop_front();
    pairs_.push_back({std::move(step), std::move(change), 1 / curvature});
  }
  /// −H·gradient, H starting from diag(inverse_diagonal) scaled to the last pair.
  Vectors direction(const Vectors& gradient, const std::vector<double>& inverse_diagonal) const {
    Vectors q = gradient;
    std::vector<double> alpha(pairs_.size());
    for (std::size_t p = pairs_.size(); p-- > 0;) {
      const Pair& pair = pairs_[p];
      alpha[p] = pair.inverse_curvature * algebra_.dot_all(pair.step, q);
      algebra_.each(q.size(), [&](std::size_t i) { q[i] -= alpha[p] * pair.change[i]; });
    }
    double scale = 1;
    if (!pairs_.empty()) {
      const Pair& last = pairs_.back();
      Vectors scaled(q.size());
      algebra_.each(q.size(), [&](std::size_t i) { scaled[i] = inverse_diagonal[i] * last.change[i]; });
      scale = 1 / (last.inverse_curvature * algebra_.dot_all(last.change, scaled));
    }
    algebra_.each(q.size(), [&](std::size_t i) { q[i] *= scale * inverse_diagonal[i]; });
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const Pair& pair = pairs_[p];
      const double beta = pair.inverse_curvature * algebra_.dot_all(pair.change, q);
      algebra_.each(q.size(), [&](std::size_t i) { q[i] += (alpha[p] - beta) * pair.step[i]; });
    }
    algebra_.each(q.size(), [&](std::size_t i) { q[i] = -q[i]; });
    return q;
  }
  bool empty() const { return pairs_.empty(); }

 private:
  static constexpr std::size_t length = 5;
  struct Pair {
    Vectors step, change;
    double inverse_curvature;
  };
  const Algebra& algebra_;
  std::deque<Pair> pairs_;
};

/// No seed may move by more than `limit` in one step.
void limit_steps(Vectors& steps, double limit) {
  for (Vec3& s : steps) {
    const double length = norm(s);
    if (length > limit) s *= limit / length;
  }
}

}  // namespace

OptimizeResult optimize(CellEvaluator& evaluator, std::vector<Vec3>& seeds, const OptimizeOptions& options,
                        ExecutionContext& context) {
  const std::size_t k = seeds.size();
  const double area = evaluator.samples().total_area;
  const double spacing = std::sqrt(area / static_cast<double>(k));
  const double small_mass = 0.1 * area / static_cast<double>(k);
  const Algebra algebra(context);
  History history(algebra);
  OptimizeResult result;
  if (options.evaluations == 0) return result;

  CellSums sums, trial_sums;
  const auto evaluate = [&](const Vectors& at, CellSums& out) {
    context.throw_if_cancelled();
    evaluator.evaluate(at, out);
    result.ratios.push_back(energy_ratio(out.energy, k, area));
  };
  evaluate(seeds, sums);
  Vectors gradient(k), step(k), trial(k), trial_gradient(k);
  std::vector<double> inverse_diagonal(k);
  const auto gradient_of = [&](const CellSums& s, Vectors& g) {
    algebra.each(k, [&](std::size_t i) { g[i] = i < options.fixed ? Vec3{} : -2.0 * s.moment[i]; });
  };
  gradient_of(sums, gradient);

  while (result.ratios.size() < options.evaluations) {
    algebra.each(k, [&](std::size_t i) { inverse_diagonal[i] = 0.5 / std::max(sums.mass[i], small_mass); });
    if (options.lloyd) history.clear();
    step = history.direction(gradient, inverse_diagonal);
    limit_steps(step, 0.5 * spacing);
    double slope = algebra.dot_all(step, gradient);
    if (!(slope < 0)) {  // not a descent direction: Lloyd's step is one
      history.clear();
      step = history.direction(gradient, inverse_diagonal);
      slope = algebra.dot_all(step, gradient);
    }
    const double mean_step =
        ordered_sum(context, k, [&](std::size_t i) { return norm(step[i]); }) / static_cast<double>(k);
    if (mean_step < options.tolerance * spacing) break;

    double factor = 1;
    bool accepted = false;
    for (int attempt = 0; attempt < 4 && result.ratios.size() < options.evaluations; ++attempt, factor *= 0.35) {
      algebra.each(k, [&](std::size_t i) { trial[i] = seeds[i] + factor * step[i]; });
      evaluate(trial, trial_sums);
      if (options.lloyd || trial_sums.energy <= sums.energy + 1e-4 * factor * slope) {
        accepted = true;
        break;
      }
    }
    if (!accepted) {
      if (history.empty()) break;
      history.clear();
      continue;
    }
    gradient_of(trial_sums, trial_gradient);
    Vectors moved(k), change(k);
    algebra.each(k, [&](std::size_t i) {
      moved[i] = trial[i] - seeds[i];
      change[i] = trial_gradient[i] - gradient[i];
    });
    history.add(std::move(moved), std::move(change));
    seeds.swap(trial);
    gradient.swap(trial_gradient);
    std::swap(sums, trial_sums);
  }
  result.energy = sums.energy;
  return result;
}

}  // namespace evenmesh
