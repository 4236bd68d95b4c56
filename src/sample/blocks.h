#pragma once
/// Writing a SampleSet's arrays.

#include <cstddef>

#include "core/parallel.h"
#include "sample/sample_set.h"

namespace evenmesh {

/// Sizes all arrays, in parallel: touching fresh memory costs as much as filling it.
/// @param with_sources  whether that array is used
void resize_samples(SampleSet& set, std::size_t count, bool with_sources, const Run& run);

/// Sets every block's axis_begin from the edge codes.
void mark_axes(SampleSet& set, const Run& run);

/// Sets total_area from the samples, summed block by block in order.
void sum_area(SampleSet& set, const Run& run);

}  // namespace evenmesh
