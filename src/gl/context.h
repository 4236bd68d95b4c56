#pragma once
/// OpenGL on a thread of its own, callable from all others.

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace evenmesh::gl {

/// A context of OpenGL 4.5 core without a window, and the thread that it is current on.
///
/// All calls of OpenGL happen in jobs. Within a job, whatever the driver may take long for (dispatches, compilations,
/// waiting) happens in steps; a step that does not come back in time is given up: whoever waits for its job gets an
/// error, the context counts as lost, and its thread never touches the caller's memory again.
class Context {
 public:
  /// @param device  see open_egl()
  /// @param limit   seconds a step may take
  /// @throws as open_egl()
  explicit Context(const std::string& device, double limit = 20);
  /// Destroys the context and ends its thread; a lost one is left to itself.
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Runs a job on the context's thread and waits for it; throws what the job throws. Jobs run one after the other, in
  /// the order of the calls; on the context's own thread at once. May be called from any thread.
  /// @throws UnusableInput  the context is lost, or is now
  void run(const std::function<void()>& job);

  /// Only within jobs: a part that may take long. It must not write to memory that does not belong to the driver or to
  /// what outlives the job.
  /// @param what  for the error: "the shader"
  void step(std::string_view what, const std::function<void()>& part);

  /// Only within jobs: waits until the device has done everything.
  void finish(std::string_view what);

  /// Only within jobs: throws what OpenGL complains about since the last call.
  /// @throws UnusableInput  out of memory, lost context, any other error of a pass
  void check(std::string_view what);

  /// Whether nothing can be done with it any more.
  bool lost() const;

  const std::string& renderer() const;  ///< e.g. "llvmpipe (LLVM 15.0.6, 256 bits)"
  const std::string& version() const;   ///< e.g. "4.5 (Core Profile) Mesa 22.3.6"
  std::size_t largest_block() const;    ///< of a storage buffer that shaders see, bytes

 private:
  struct Worker;
  void close();
  std::shared_ptr<Worker> worker_;
};

/// The one context of a device, opened by the first call and kept until the process ends.
/// @throws as Context
std::shared_ptr<Context> shared_context(const std::string& device);

/// Whether any context of this process was given up; see gl_stuck().
bool stuck();

}  // namespace evenmesh::gl
