#pragma once
/// The same surface on a grid of twice the spacing.

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// Every other ray of `fine` in both directions across it: the samples of a grid with twice the spacing (several per
/// edge are kept), areas and weights times four, in blocks of that grid's bricks with edge codes of that grid. Cost:
/// O(samples).
SampleSet coarsen(const SampleSet& fine, ExecutionContext& context = ExecutionContext::silent());

}  // namespace evenmesh
