#include "cvt/optimize.h"

#include <algorithm>
#include <cmath>

#include "core/lbfgs.h"

namespace evenmesh {
namespace {

using Vectors = std::vector<Vec3>;

/// No seed may move by more than `limit` in one step.
void limit_steps(Vectors& steps, double limit) {
  for (Vec3& s : steps) {
    const double length = norm(s);
    if (length > limit) s *= limit / length;
  }
}

/// Steps downhill until they are short, or evaluations are used up.
class Descent {
 public:
  Descent(CellEvaluator& evaluator, Seeds& seeds, const OptimizeOptions& options, ExecutionContext& context)
      : evaluator_(evaluator),
        seeds_(seeds.positions),
        fixed_(seeds.fixed.size()),
        moving_(count_moving(seeds, options)),
        options_(options),
        context_(context),
        area_(evaluator.samples().total_area),
        gradient_(seeds.size()),
        step_(seeds.size()),
        trial_(seeds.size()),
        trial_gradient_(seeds.size()),
        inverse_diagonal_(seeds.size()) {}

  OptimizeResult run() {
    evaluate(seeds_, sums_);
    find_gradient(sums_, gradient_);
    while (!used_up()) {
      const double slope = find_step();
      if (mean_step() < options_.tolerance * spacing()) break;
      if (try_step(slope)) {
        take_step();
      } else {
        if (history_.empty()) break;
        history_.clear();
      }
    }
    result_.energy = sums_.energy;
    return std::move(result_);
  }

 private:
  /// At least 1. Fixed ones count as if they moved: where there are no others nothing is frozen.
  static std::size_t count_moving(const Seeds& seeds, const OptimizeOptions& options) {
    const auto frozen = std::count_if(options.frozen.begin(), options.frozen.end(), [](char f) { return f != 0; });
    return std::max<std::size_t>(1, seeds.size() - static_cast<std::size_t>(frozen));
  }
  std::size_t count() const { return seeds_.size(); }
  double spacing() const { return std::sqrt(area_ / static_cast<double>(count())); }
  bool stays(std::size_t i) const { return i < fixed_ || (i < options_.frozen.size() && options_.frozen[i] != 0); }
  bool used_up() const { return result_.ratios.size() >= options_.evaluations; }

  void evaluate(const Vectors& at, CellSums& out) {
    context_.throw_if_cancelled();
    evaluator_.evaluate(at, out);
    result_.ratios.push_back(energy_ratio(out.energy, count(), area_));
  }
  void find_gradient(const CellSums& sums, Vectors& gradient) const {
    algebra_.each(count(), [&](std::size_t i) { gradient[i] = stays(i) ? Vec3{} : -2.0 * sums.moment[i]; });
  }

  /// @return its product with the gradient
  double find_step() {
    const double small_mass = 0.1 * area_ / static_cast<double>(count());
    algebra_.each(count(), [&](std::size_t i) { inverse_diagonal_[i] = 0.5 / std::max(sums_.mass[i], small_mass); });
    if (options_.lloyd) history_.clear();
    step_ = history_.direction(gradient_, inverse_diagonal_);
    limit_steps(step_, 0.5 * spacing());
    const double slope = algebra_.dot_all(step_, gradient_);
    if (slope < 0) return slope;
    history_.clear();  // not a descent direction: Lloyd's step is one
    step_ = history_.direction(gradient_, inverse_diagonal_);
    return algebra_.dot_all(step_, gradient_);
  }
  double mean_step() const {
    return ordered_sum(context_, count(), [&](std::size_t i) { return norm(step_[i]); }) / static_cast<double>(moving_);
  }

  /// Shorter and shorter steps; whether one of them leads down far enough.
  bool try_step(double slope) {
    double factor = 1;
    for (int attempt = 0; attempt < 4 && !used_up(); ++attempt, factor *= 0.35) {
      algebra_.each(count(), [&](std::size_t i) { trial_[i] = seeds_[i] + factor * step_[i]; });
      evaluate(trial_, trial_sums_);
      if (options_.lloyd || trial_sums_.energy <= sums_.energy + 1e-4 * factor * slope) return true;
    }
    return false;
  }
  void take_step() {
    find_gradient(trial_sums_, trial_gradient_);
    Vectors moved(count()), change(count());
    algebra_.each(count(), [&](std::size_t i) {
      moved[i] = trial_[i] - seeds_[i];
      change[i] = trial_gradient_[i] - gradient_[i];
    });
    history_.add(std::move(moved), std::move(change));
    seeds_.swap(trial_);
    gradient_.swap(trial_gradient_);
    std::swap(sums_, trial_sums_);
  }

  CellEvaluator& evaluator_;
  Vectors& seeds_;
  std::size_t fixed_;  ///< of them, the first ones
  std::size_t moving_;
  const OptimizeOptions& options_;
  ExecutionContext& context_;
  const double area_;
  const VariableAlgebra<Vec3> algebra_{context_};
  LimitedMemoryHessian<Vec3> history_{algebra_};
  OptimizeResult result_;
  CellSums sums_, trial_sums_;
  Vectors gradient_, step_, trial_, trial_gradient_;
  std::vector<double> inverse_diagonal_;
};

}  // namespace

OptimizeResult optimize(CellEvaluator& evaluator, Seeds& seeds, const OptimizeOptions& options,
                        ExecutionContext& context) {
  if (options.evaluations == 0) return {};
  return Descent(evaluator, seeds, options, context).run();
}

}  // namespace evenmesh
