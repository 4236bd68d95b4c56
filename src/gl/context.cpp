#include "gl/context.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <utility>

#include "evenmesh/error.h"
#include "gl/egl.h"

namespace evenmesh::gl {
namespace {

using Clock = std::chrono::steady_clock;

std::atomic<bool> any_stuck{false};

/// Compilers of shaders are recursive; deep expressions need a deep stack. Only what is used takes memory.
constexpr std::size_t stack_bytes = std::size_t{256} << 20;

struct Job {
  const std::function<void()>* body = nullptr;
  std::exception_ptr error = nullptr;
  bool done = false;
};

}  // namespace

/// Shared by the thread and the callers; all below the mutex is guarded by it.
struct Context::Worker {
  double limit = 0;
  pthread_t thread{};
  EglContext egl{};
  std::size_t largest_block = 0;

  mutable std::mutex mutex{};
  std::condition_variable work{}, progress{};
  std::deque<Job*> queue{};
  Job* running = nullptr;
  std::string step{};  ///< what the driver works on; empty: nothing that may take long
  Clock::time_point since{};
  std::string loss{};      ///< why the context is lost; empty: it is not
  bool abandoned = false;  ///< nobody waits for the running job
  bool quit = false;

  void serve();
  void wait_for(Job& job, std::unique_lock<std::mutex>& lock);
  void give_up_if_late();
};

void Context::Worker::serve() {
  std::unique_lock lock(mutex);
  for (;;) {
    work.wait(lock, [&] { return quit || !queue.empty(); });
    if (queue.empty()) return;
    running = queue.front();
    queue.pop_front();
    lock.unlock();
    std::exception_ptr error;
    try {
      (*running->body)();
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    running->error = error;
    running->done = true;
    running = nullptr;
    progress.notify_all();
  }
}

void Context::Worker::give_up_if_late() {
  const double seconds = std::chrono::duration<double>(Clock::now() - since).count();
  if (!loss.empty() || step.empty() || seconds < limit) return;
  loss = fmt::format("{} did not come back within {:.3g} s: it may never end; make it simpler, or try another device",
                     step, limit);
  abandoned = true;
  any_stuck = true;
  progress.notify_all();
}

/// Any of the waiting callers is the watchdog of the running job.
void Context::Worker::wait_for(Job& job, std::unique_lock<std::mutex>& lock) {
  while (!job.done) {
    progress.wait_for(lock, std::chrono::milliseconds(50));
    if (job.done) return;
    give_up_if_late();
    if (loss.empty() || (running == &job && !abandoned)) continue;
    queue.erase(std::remove(queue.begin(), queue.end(), &job), queue.end());
    throw UnusableInput(loss);
  }
}

Context::Context(const std::string& device, double limit) : worker_(std::make_shared<Worker>()) {
  worker_->limit = limit;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, stack_bytes);
  auto owned = std::make_unique<std::shared_ptr<Worker>>(worker_);
  const auto serve = [](void* argument) -> void* {
    const std::unique_ptr<std::shared_ptr<Worker>> worker(static_cast<std::shared_ptr<Worker>*>(argument));
    (*worker)->serve();
    return nullptr;
  };
  const int status = pthread_create(&worker_->thread, &attributes, serve, owned.get());
  pthread_attr_destroy(&attributes);
  if (status != 0) throw UnusableInput("a thread for OpenGL cannot be started; free memory");
  (void)owned.release();  // the thread's now
  try {
    run([&] {
      const std::shared_ptr<Worker> worker = worker_;
      step("the driver of OpenGL", [worker, device] { worker->egl = open_egl(device); });
      GLint bytes = 0;
      glGetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
      worker->largest_block = static_cast<std::size_t>(std::max(bytes, 0));
    });
  } catch (...) {
    close();
    throw;
  }
}

Context::~Context() {
  close();
}

void Context::close() {
  const std::shared_ptr<Worker> worker = worker_;
  std::unique_lock lock(worker->mutex);
  if (worker->abandoned) {
    pthread_detach(worker->thread);
    return;
  }
  const std::function<void()> close = [&] {
    if (worker->egl.context != nullptr) close_egl(worker->egl);
  };
  Job last{&close};
  worker->queue.push_back(&last);
  worker->quit = true;
  worker->work.notify_one();
  lock.unlock();
  pthread_join(worker->thread, nullptr);
}

void Context::run(const std::function<void()>& job) {
  if (pthread_equal(pthread_self(), worker_->thread) != 0) return job();
  Job mine{&job};
  std::unique_lock lock(worker_->mutex);
  if (!worker_->loss.empty()) throw UnusableInput(worker_->loss);
  worker_->queue.push_back(&mine);
  worker_->work.notify_one();
  worker_->wait_for(mine, lock);
  if (mine.error) std::rethrow_exception(mine.error);
}

void Context::step(std::string_view what, const std::function<void()>& part) {
  // A copy: whoever waits may be gone, and the context with them, when the driver comes back.
  const std::shared_ptr<Worker> worker = worker_;
  {
    const std::lock_guard lock(worker->mutex);
    worker->step = what;
    worker->since = Clock::now();
  }
  std::exception_ptr error;
  try {
    part();
  } catch (...) {
    error = std::current_exception();
  }
  std::unique_lock lock(worker->mutex);
  worker->step.clear();
  if (!worker->abandoned) {
    if (error) std::rethrow_exception(error);
    return;
  }
  for (;;) worker->work.wait(lock);  // the job's memory is gone: this thread must not go on
}

void Context::finish(std::string_view what) {
  step(what, [] { glFinish(); });
}

void Context::check(std::string_view what) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  while (glGetError() != GL_NO_ERROR && glGetGraphicsResetStatus() == GL_NO_ERROR) {
  }
  if (error == GL_CONTEXT_LOST || glGetGraphicsResetStatus() != GL_NO_ERROR) {
    const std::lock_guard lock(worker_->mutex);
    worker_->loss = fmt::format("the graphics device was reset by {}; make it simpler, or try another device", what);
    throw UnusableInput(worker_->loss);
  }
  if (error == GL_OUT_OF_MEMORY)
    throw UnusableInput(fmt::format("the graphics device has no memory left for {}; try another device", what));
  throw UnusableInput(fmt::format("OpenGL refused {} (error {:#06x}, {}); try another device, and report this", what,
                                  error, renderer()));
}

bool Context::lost() const {
  const std::lock_guard lock(worker_->mutex);
  return !worker_->loss.empty();
}

const std::string& Context::renderer() const {
  return worker_->egl.renderer;
}

const std::string& Context::version() const {
  return worker_->egl.version;
}

std::size_t Context::largest_block() const {
  return worker_->largest_block;
}

std::shared_ptr<Context> shared_context(const std::string& device) {
  // Never destroyed: drivers undo themselves at exit, perhaps before anything of ours would be.
  static auto& mutex = *new std::mutex;
  static auto& contexts = *new std::map<std::string, std::shared_ptr<Context>>;
  const std::lock_guard lock(mutex);
  std::shared_ptr<Context>& context = contexts[device];
  if (!context) context = std::make_shared<Context>(device);
  return context;
}

bool stuck() {
  return any_stuck;
}

}  // namespace evenmesh::gl
