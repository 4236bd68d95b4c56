#pragma once
/// The pipeline's clock: progress, and time per stage.

#include <chrono>
#include <string>

#include "evenmesh/mesh_shape.h"

namespace evenmesh {

/// Times the stages of a run and reports their progress. A stage's weight is its usual share of the run.
class Stages {
 public:
  Stages(Run& run, Report& report) : run_(run), report_(report) {}

  template <typename Work>
  auto stage(const std::string& name, double weight, const Work& work) {
    run_.report(name, done_);
    const Timer timer(*this, name, weight);
    return work();
  }

 private:
  struct Timer {
    Stages& stages;
    const std::string& name;
    double weight;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    Timer(Stages& s, const std::string& n, double w) : stages(s), name(n), weight(w) {}
    ~Timer() {
      stages.add(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      stages.done_ = std::min(0.99, stages.done_ + weight);
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

  Run& run_;
  Report& report_;
  double done_ = 0;
};

}  // namespace evenmesh
