#pragma once
/// Seeds that come from a coarser mesh, where that could not follow the shape.

#include "pipeline/tessellator.h"

namespace evenmesh {

/// Cells much heavier than they should be get more seeds, much lighter ones lose theirs, and seeds within a few edges
/// of these, and of seeds far off their cell's centroid, are relaxed; the others stay.
/// @param thinner  evaluates the same surface, maybe with fewer samples: enough to tell what does not fit
/// @param least, most  number of seeds in the end, the fixed ones included
void repair_misfits(Tessellator& state, CellEvaluator& thinner, std::size_t least, std::size_t most);

}  // namespace evenmesh
