#pragma once
/// The pipeline's clock: progress, and time per stage.

#include <chrono>
#include <string>

#include "evenmesh/mesh_shape.h"

namespace evenmesh {

/// Times the stages of a run and reports their progress. A stage's weight is its usual share of the run.
class StageTimer {
 public:
  StageTimer(ExecutionContext& context, Report& report) : context_(context), report_(report) {}

  template <typename Work>
  auto stage(const std::string& name, double weight, const Work& work) {
    context_.report(name, done_);
    const Timer timer(*this, name, weight);
    return work();
  }

 private:
  struct Timer {
    StageTimer& timer;
    const std::string& name;
    double weight;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    Timer(StageTimer& s, const std::string& n, double w) : timer(s), name(n), weight(w) {}
    ~Timer() {
      timer.add(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      timer.done_ = std::min(0.99, timer.done_ + weight);
    }
  };
  void add(const std::string& name, double seconds) {
    for (auto& [stage, total] : report_.seconds)
      if (stage == name) {
        total += seconds;
        return;
      }
    report_.seconds.push_back({name, seconds});
  }

  ExecutionContext& context_;
  Report& report_;
  double done_ = 0;
};

}  // namespace evenmesh
