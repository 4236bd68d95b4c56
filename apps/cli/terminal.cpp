#include "terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace evenmesh::cli {
namespace {

std::string minutes_and_seconds(double seconds) {
  const long whole = static_cast<long>(seconds + 0.5);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

Terminal::Terminal(ExecutionContext& context, Talk talk, const std::string& progress) : context_(context) {
  const bool bar = progress == "on" || (progress == "auto" && talk != Talk::quiet && isatty(STDERR_FILENO) == 1);
  if (bar) context.on_progress([this](std::string_view stage, double fraction) { draw(stage, fraction); });
  if (talk == Talk::verbose) {
    context.on_log([this](std::string_view line) {
      wipe();
      fmt::print(stderr, "{}\n", line);
    });
  }
}

Terminal::~Terminal() {
  context_.on_progress({});
  context_.on_log({});
  wipe();
}

void Terminal::wipe() {
  const std::lock_guard lock(mutex_);
  if (visible_) std::fputs("\r\x1b[K", stderr);
  visible_ = false;
}

void Terminal::draw(std::string_view stage, double fraction) {
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (visible_ && now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  visible_ = true;
  constexpr int width = 30;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int full = static_cast<int>(fraction * width);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  // The first moments say nothing about the rest.
  const std::string left = fraction > 0.02 && elapsed > 0.3
                               ? minutes_and_seconds(elapsed * (1 - fraction) / fraction) + " left"
                               : std::string();
  fmt::print(stderr, "\r\x1b[K{:<16.16} [{:#>{}}{:.>{}}] {:3.0f} %  {}", stage, "", full, "", width - full,
             100 * fraction, left);
  std::fflush(stderr);
}

void say(std::string_view kind, std::string_view sentence) {
  fmt::print(stderr, "{}: {}\n", kind, sentence);
}

void say(const Finding& finding) {
  const bool broken = finding.severity == Severity::broken_promise;
  say(broken ? "promise not kept" : finding.severity == Severity::note ? "note" : "warning", finding.sentence);
}

}  // namespace evenmesh::cli
