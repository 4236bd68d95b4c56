#pragma once
/// The pipeline's clock: progress, and time per stage.

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "evenmesh/execution_context.h"

namespace evenmesh {

/// Times the stages of a run and reports their progress. A stage's weight is its usual share of the run.
class StageTimer {
 public:
  explicit StageTimer(ExecutionContext& context) : context_(context) {}

  template <typename Work>
  auto stage(const std::string& name, double weight, const Work& work) {
    context_.report(name, done_);
    const Clock clock(*this, name, weight);
    return work();
  }

  /// By stage, in the order in which they first began.
  const std::vector<std::pair<std::string, double>>& seconds() const { return seconds_; }

 private:
  struct Clock {
    StageTimer& timer;
    const std::string& name;
    double weight;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    Clock(StageTimer& t, const std::string& n, double w) : timer(t), name(n), weight(w) {}
    ~Clock() {
      timer.add(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      timer.done_ = std::min(0.99, timer.done_ + weight);
    }
  };
  void add(const std::string& name, double seconds) {
    for (auto& [stage, total] : seconds_)
      if (stage == name) {
        total += seconds;
        return;
      }
    seconds_.push_back({name, seconds});
  }

  ExecutionContext& context_;
  std::vector<std::pair<std::string, double>> seconds_;
  double done_ = 0;
};

}  // namespace evenmesh
