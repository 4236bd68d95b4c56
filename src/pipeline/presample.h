#pragma once
/// What a coarse sampling tells of a surface.

#include "grid/sample_set.h"
#include "pipeline/sampler.h"

namespace evenmesh {

/// What a coarse sampling tells about a surface. Lengths in model units.
struct SurfaceScale {
  double area = 0;
  double samples_per_area = 0;       ///< times h²: Σ_a ∫ |n_a| / area, between 1 and √3
  double curvature_radius = 0;       ///< nine tenths of the surface are curved less than 1 / this
  double thickness = 0;              ///< of the thinnest parts (2 % of the area are thinner), infinite if none is seen
  std::size_t small_components = 0;  ///< pieces of surface of a few grid cells: small components, as around fractals
};

/// Curvature from the change of normals between near samples, thickness from near samples that face away from each
/// other through the solid. Only parts thinner than eight grid cells are seen as thin. Cost: O(samples).
SurfaceScale measure_scale(const SampleSet& coarse, ExecutionContext& context);

/// Samples the shape coarsely and measures it. A grid that is too coarse for thin parts sees holes in them, or nothing
/// at all; then finer ones are tried, up to `finest` cells along the longest side (at least four times the coarsest).
/// @throws UnusableInput  no surface within the bounds
SurfaceScale presample(const Sampler& sampler, std::size_t finest, ExecutionContext& context);

}  // namespace evenmesh
