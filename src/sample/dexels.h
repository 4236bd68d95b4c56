#pragma once
/// Samples of a solid as dexels, and back.

#include "core/parallel.h"
#include "evenmesh/dexels.h"
#include "grid/sample_set.h"

namespace evenmesh {

Dexels dexels_of(const SampleSet& samples);

/// @throws UnusableInput  crossings beyond the grid, twice on an edge, or that do not agree on what is inside
SampleSet samples_of(const Dexels& dexels, const ExecutionContext& context);

}  // namespace evenmesh
