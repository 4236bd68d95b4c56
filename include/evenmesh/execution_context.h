#pragma once
/// How a computation runs, as opposed to what it computes: nothing in here may change a result.

#include <atomic>
#include <functional>
#include <string>
#include <string_view>

#include "evenmesh/error.h"

namespace evenmesh {

/// Carries threads, progress, cancellation and log through a long computation.
///
/// One ExecutionContext may be shared by several threads. Results never depend on it.
class ExecutionContext {
 public:
  /// Called with the stage that is running and the finished share of the whole job, in [0, 1], never decreasing.
  using Progress = std::function<void(std::string_view stage, double fraction)>;
  /// Called with one line of text, without newline.
  using Log = std::function<void(std::string_view line)>;

  ExecutionContext() = default;
  /// @param threads  number of worker threads, 0 = one per processor
  explicit ExecutionContext(unsigned threads) : threads_(threads) {}

  unsigned threads() const { return threads_; }
  void on_progress(Progress callback) { progress_ = std::move(callback); }
  void on_log(Log callback) { log_ = std::move(callback); }

  /// Asks the computation to stop; it then throws Cancelled. Safe from any thread and from a signal handler.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }
  void throw_if_cancelled() const {
    if (cancelled()) throw Cancelled();
  }

  /// Reports that `stage` is running and `fraction` of the whole job is done; also the point where cancel() takes
  /// effect.
  void report(std::string_view stage, double fraction) {
    throw_if_cancelled();
    if (progress_) progress_(stage, fraction);
  }
  void log(std::string_view line) {
    if (log_) log_(line);
  }

  /// A ExecutionContext for callers that do not care: all processors, no progress, no log.
  static ExecutionContext& silent();

 private:
  unsigned threads_ = 0;
  std::atomic<bool> cancelled_{false};
  Progress progress_;
  Log log_;
};

}  // namespace evenmesh
