#pragma once
/// Writing a SampleSet's columns, and copying some of its samples.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// Sizes the columns of an even set, in parallel: touching fresh memory costs as much as filling it.
/// @param with_sources  whether that column is used
void resize_samples(SampleSet& set, std::size_t count, bool with_sources, const ExecutionContext& context);

/// Sizes the columns that `like` has, and empties the others.
void resize_like(SampleColumns& to, const SampleColumns& like, std::size_t count, const ExecutionContext& context);

/// Sets every block's axis_begin from the edge codes.
void mark_axes(SampleSet& set, const ExecutionContext& context);

/// Sets total_area and total_weight from the samples, summed block by block in order.
void sum_area(SampleSet& set, const ExecutionContext& context);

/// Writes sample `index` of `from` to place `at`: all columns that both have.
inline void copy_sample(const SampleColumns& from, std::size_t index, SampleColumns& to, std::size_t at) {
  for_each_column(
      [&](const auto& source, auto& target) {
        if (!source.empty() && !target.empty()) target[at] = source[index];
      },
      from, to);
}

/// Writes samples [begin, end) of `from` to the places from `at` on: all columns that both have.
inline void copy_samples(const SampleColumns& from, std::size_t begin, std::size_t end, SampleColumns& to,
                         std::size_t at) {
  for_each_column(
      [&](const auto& source, auto& target) {
        if (!source.empty() && !target.empty()) std::copy_n(source.data() + begin, end - begin, target.data() + at);
      },
      from, to);
}

/// The samples of `set` with these indices, ascending, and what else is known of the set; blocks without samples go.
/// Areas and weights of those left out are taken off the totals one by one. The result bounds no solid any more unless
/// whole components of the surface went. Cost: O(samples).
SampleSet gather(const SampleSet& set, std::span<const std::uint32_t> index,
                 const ExecutionContext& context = ExecutionContext::silent());

/// The blocks with these indices, ascending, as a set of their own that knows which bricks around it were left out. Its
/// totals remain those of the whole: what a mean cell is does not change. Cost: O(samples of the part).
SampleSet part_of(const SampleSet& whole, std::span<const std::uint32_t> blocks,
                  const ExecutionContext& context = ExecutionContext::silent());

/// The samples for which keep(index) is true, as gather().
template <typename Keep>
SampleSet keep_samples(const SampleSet& set, const Keep& keep,
                       const ExecutionContext& context = ExecutionContext::silent()) {
  std::vector<std::uint32_t> index;
  for (std::uint32_t i = 0; i < set.size(); ++i)
    if (keep(i)) index.push_back(i);
  return gather(set, index, context);
}

}  // namespace evenmesh
