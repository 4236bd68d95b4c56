#pragma once
/// Samples weighted so that balanced seeds are denser where they shall be.

#include "evenmesh/density.h"
#include "evenmesh/execution_context.h"
#include "grid/sample_set.h"

namespace evenmesh {

struct WeightedSamples {
  SampleSet samples;
  double mean_density = 1;  ///< over the surface, by area
  double max_density = 1;   ///< so many times the mean as this is, so many times fewer samples has the smallest cell
};

/// Gives every sample the weight area · (n / n̄)², n the density there, vertices per area in any unit, and n̄ its mean
/// over the surface.
///
/// Balanced seeds give every cell the same ∫√ρ on a surface, ρ the weight per area (Gersho's conjecture, [NBEDT §3.3]
/// and Du, Faber, Gunzburger, Centroidal Voronoi tessellations, SIAM Review 41(4), 1999). So n seeds per area come from
/// ρ ∝ n². Edges e are as long as n ∝ e⁻², hence ρ = (ē / e)⁴ with ē the edge length of an even mesh of as many
/// vertices: what a SizingField gives directly. With this scale ∫√ρ is the area, and the energy of the best
/// cells is that of an even surface, F = 5/(18√3) · area² / seeds: energy_ratio() means the same as without a density.
///
/// Areas stay. Cost: the density once per sample. Same bytes for any number of threads.
/// @throws InvalidInput  the density is not above 0 and finite at a sample
WeightedSamples weigh_by_density(SampleSet samples, const Density& density, ExecutionContext& context);

}  // namespace evenmesh
