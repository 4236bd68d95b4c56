#pragma once
/// Writing a SampleSet's arrays.

#include <cstddef>

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// Sizes all arrays, in parallel: touching fresh memory costs as much as filling it.
/// @param with_sources  whether that array is used
void resize_samples(SampleSet& set, std::size_t count, bool with_sources, const ExecutionContext& context);

/// Sets every block's axis_begin from the edge codes.
void mark_axes(SampleSet& set, const ExecutionContext& context);

/// Leaves out the samples for which keep(index) is false, and blocks without samples. The order stays; the rest bounds
/// no solid any more unless whole parts of the surface go.
template <typename Keep>
void keep_samples(SampleSet& set, const Keep& keep);

/// Sets total_area from the samples, summed block by block in order.
void sum_area(SampleSet& set, const ExecutionContext& context);

template <typename Keep>
void keep_samples(SampleSet& set, const Keep& keep) {
  std::uint32_t kept = 0;
  std::vector<SampleBlock> blocks;
  for (const SampleBlock& block : set.blocks) {
    SampleBlock rest{kept, kept, block.brick, {}};
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) rest.axis_begin[static_cast<std::size_t>(axis) - 1] = kept;
      for (std::uint32_t i = block.begin_of_axis(axis); i < block.end_of_axis(axis); ++i) {
        if (!keep(i)) {
          set.total_area -= set.area[i];
          continue;
        }
        set.x[kept] = set.x[i];
        set.y[kept] = set.y[i];
        set.z[kept] = set.z[i];
        set.area[kept] = set.area[i];
        set.normal[kept] = set.normal[i];
        set.edge[kept] = set.edge[i];
        if (!set.source.empty()) set.source[kept] = set.source[i];
        ++kept;
      }
    }
    rest.end = kept;
    if (rest.end > rest.begin) blocks.push_back(rest);
  }
  set.blocks = std::move(blocks);
  for (auto* array : {&set.x, &set.y, &set.z, &set.area}) array->resize(kept);
  set.normal.resize(kept);
  set.edge.resize(kept);
  if (!set.source.empty()) set.source.resize(kept);
}

}  // namespace evenmesh
