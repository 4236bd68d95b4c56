#pragma once
/// Ctrl-C and SIGTERM: the computation stops, nothing is written, exit status 130.

#include "evenmesh/execution_context.h"

namespace evenmesh::cli {

/// Takes over SIGINT and SIGTERM. Call once, first thing in main, before any other thread exists.
void watch_for_interrupts();

/// While one lives, the first interrupt cancels `context`. If the program has not ended by itself within 0.4 s, or at a
/// second interrupt, it is ended at once.
class CancelOnInterrupt {
 public:
  explicit CancelOnInterrupt(ExecutionContext& context);
  ~CancelOnInterrupt();
  CancelOnInterrupt(const CancelOnInterrupt&) = delete;
  CancelOnInterrupt& operator=(const CancelOnInterrupt&) = delete;
};

/// While one lives, an interrupt waits, and afterwards it is too late: all files of a run appear, or none.
class WritingGuard {
 public:
  /// @throws Cancelled  an interrupt came before
  WritingGuard();
  ~WritingGuard();
  WritingGuard(const WritingGuard&) = delete;
  WritingGuard& operator=(const WritingGuard&) = delete;
};

}  // namespace evenmesh::cli
