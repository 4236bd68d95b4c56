#pragma once
/// Booleans of sampled solids, edge by edge of their grid.

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

enum class Boolean { unite, intersect, subtract };

/// The samples of A ∪ B, A ∩ B or A \ B.
///
/// An edge whose ends differ in the result keeps a crossing: that of the operand which decides it, of two the first or
/// last along the edge, of A where both are equal. Where parts of both meet within one edge what lies between its ends
/// is not seen, as in the operands. Samples have no source. Guarantee: the result bounds a solid whose inside points
/// are exactly the boolean of the operands'; A op A = A, and De Morgan's laws, bit for bit; same bits for any number of
/// threads. Cost: about 50 ns per sample of A and B.
/// @param a, b  on the same grid, not weighted; nor is the result
/// Based on [Raster2Mesh §5.1.2].
SampleSet combine(const SampleSet& a, const SampleSet& b, Boolean operation, const ExecutionContext& context);

}  // namespace evenmesh
