#pragma once
/// The same surface on a grid of twice the spacing.

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// Every other ray of `fine` in both directions across it: the samples of a grid with twice the spacing (several per
/// edge are kept), areas and weights times four, in blocks of that grid's bricks with edge codes of that grid. Cost:
/// O(samples).
SampleSet coarsen(const SampleSet& fine, ExecutionContext& context = ExecutionContext::silent());

/// The solid that a grid sees: of several samples on one edge, as coarsen() keeps them, one stays where they are an odd
/// number, none where they are even. What is thinner than the grid's cells goes. Samples in a block are sorted by edge
/// code. Cost: O(samples).
SampleSet one_sample_per_edge(const SampleSet& set, const ExecutionContext& context = ExecutionContext::silent());

}  // namespace evenmesh
