#pragma once
/// Samples weighted so that balanced seeds are denser where they shall be.

#include "evenmesh/density.h"
#include "evenmesh/execution_context.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// Multiplies every sample's area by the square of the density, scaled so that the total stays.
///
/// Balanced seeds give every cell the same ∫ρ^½ on a surface, ρ the weight (Gersho's conjecture, [NBEDT §3.3] and Du,
/// Faber, Gunzburger, Centroidal Voronoi tessellations, SIAM Review 41(4), 1999): ρ is the square of how many are
/// wanted per area. Returns the largest density over its mean: so many times fewer samples than on average has the
/// smallest cell.
/// @throws InvalidInput  the density is not above 0 and finite at a sample
double weigh_by_density(SampleSet& samples, const Density& density, ExecutionContext& context);

}  // namespace evenmesh
