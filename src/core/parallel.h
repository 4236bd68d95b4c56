#pragma once
/// The one façade for threads (oneTBB behind it).

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "evenmesh/execution_context.h"

namespace evenmesh {

/// Runs `body()` with at most run.threads() threads, and no more than there are processors; parallel_for calls inside
/// it obey the limit.
template <typename Body>
auto with_threads(const ExecutionContext& context, Body&& body) {
  const auto processors = static_cast<unsigned>(tbb::info::default_concurrency());
  tbb::task_arena arena(
      static_cast<int>(context.threads() == 0 ? processors : std::min(context.threads(), processors)));
  return arena.execute(body);
}

/// How many threads may work at once here. What is computed must not depend on it.
inline std::size_t threads_here() {
  return static_cast<std::size_t>(std::max(1, tbb::this_task_arena::max_concurrency()));
}

/// Calls body(begin, end) over pieces of [0, count) of at least `grain` items, in parallel; honours cancel between
/// pieces.
template <typename Body>
void parallel_for(const ExecutionContext& context, std::size_t count, std::size_t grain, const Body& body) {
  if (count == 0) return;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      context.throw_if_cancelled();
                      body(range.begin(), range.end());
                    });
}

/// Calls body(i) for every i in [0, count), each a task of its own: for few, large items.
template <typename Body>
void parallel_tasks(const ExecutionContext& context, std::size_t count, const Body& body) {
  parallel_for(context, count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// Sorts ascending. Items that compare equal must be the same: then so is the result for any number of threads.
template <typename Item>
void parallel_sort(const ExecutionContext& context, std::vector<Item>& items) {
  context.throw_if_cancelled();
  tbb::parallel_sort(items.begin(), items.end());
}

}  // namespace evenmesh
