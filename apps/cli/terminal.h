#pragma once
/// What the user sees while a command runs: progress bar, log lines, warnings. All on standard error.

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

#include "evenmesh/execution_context.h"
#include "evenmesh/findings.h"

namespace evenmesh::cli {

enum class Talk { quiet, normal, verbose };

/// Draws the progress of a ExecutionContext on a terminal and passes its log on. Detaches and wipes the bar when it
/// goes.
class Terminal {
 public:
  /// @param progress  "auto" (bar on a terminal only), "on" or "off"
  Terminal(ExecutionContext& context, Talk talk, const std::string& progress);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Removes the bar; later progress draws it again.
  void wipe();

 private:
  void draw(std::string_view stage, double fraction);

  ExecutionContext& context_;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point drawn_{};
  bool visible_ = false;
};

/// "error: …", "warning: …" as one line on standard error.
void say(std::string_view kind, std::string_view sentence);
/// The finding's sentence, as a note, a warning, or a promise not kept.
void say(const Finding& finding);

}  // namespace evenmesh::cli
