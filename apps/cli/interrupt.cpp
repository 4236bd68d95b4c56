#include "interrupt.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <ctime>
#include <mutex>
#include <string_view>
#include <thread>

#include "command.h"

namespace evenmesh::cli {
namespace {

std::mutex state;  // guards the three below; held while files appear
ExecutionContext* running = nullptr;
bool interrupted = false;
bool written = false;

sigset_t interrupts() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

void wait_for_interrupts() {
  const sigset_t set = interrupts();
  int signal = 0;
  if (sigwait(&set, &signal) != 0) return;
  {
    const std::lock_guard lock(state);
    if (written) return;
    interrupted = true;
    if (running) running->cancel();
  }
  // The library looks at the flag often; a blocked read of standard input, for one, does not.
  const timespec patience{.tv_sec = 0, .tv_nsec = 400'000'000};
  sigtimedwait(&set, nullptr, &patience);
  constexpr std::string_view sentence = "\ncancelled; nothing was written\n";
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, sentence.data(), sentence.size());
  _exit(Status::cancelled);
}

}  // namespace

void watch_for_interrupts() {
  // Blocked in every thread, the signals reach only the one that waits for them.
  const sigset_t set = interrupts();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  std::thread(wait_for_interrupts).detach();
}

CancelOnInterrupt::CancelOnInterrupt(ExecutionContext& context) {
  const std::lock_guard lock(state);
  running = &context;
  if (interrupted) context.cancel();
}

CancelOnInterrupt::~CancelOnInterrupt() {
  const std::lock_guard lock(state);
  running = nullptr;
}

WritingGuard::WritingGuard() {
  state.lock();
  if (interrupted) {
    state.unlock();
    throw Cancelled();
  }
}

WritingGuard::~WritingGuard() {
  written = true;
  state.unlock();
}

}  // namespace evenmesh::cli
