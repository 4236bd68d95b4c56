#pragma once
/// How fine: vertex count and grid from what the user said, or from the shape.

#include "evenmesh/mesh_shape.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// What a coarse sampling tells about a surface. Lengths in model units.
struct SurfaceScale {
  double area = 0;
  double samples_per_area = 0;       ///< times h²: Σ_a ∫ |n_a| / area, between 1 and √3
  double curvature_radius = 0;       ///< nine tenths of the surface are curved less than 1 / this
  double thickness = 0;              ///< of the thinnest parts (2 % of the area are thinner), infinite if none is seen
  std::size_t small_components = 0;  ///< pieces of surface of a few grid cells: dust, as around fractals
};

/// Curvature from the change of normals between near samples, thickness from near samples that face away from each
/// other through the solid. Only parts thinner than eight grid cells are seen as thin. Cost: O(samples).
SurfaceScale measure_scale(const SampleSet& coarse, ExecutionContext& context);

/// Samples the shape coarsely and measures it. A grid that is too coarse for thin parts sees holes in them, or nothing
/// at all; then finer ones are tried, up to `finest` cells along the longest side (at least four times the coarsest).
/// @throws UnusableInput  no surface within the bounds
SurfaceScale presample(const Shape& shape, std::size_t finest, ExecutionContext& context);

/// Mean edge length of an even mesh with n vertices on an area: √(2·area / (√3·n)), and back.
double edge_length_of(double area, double vertices);
double vertices_of(double area, double edge_length);

struct Fineness {
  std::size_t vertices = 0;
  std::size_t resolution = 0;  ///< grid cells along the longest side
};

/// Vertex count asked for, or estimated: edges turn by about 20° where the surface is curved most, and are no longer
/// than thin parts are thick; the grid so that every seed has 100 samples and thin parts have cells inside. Adds
/// notices where a wish had to be changed: at least 50 samples per seed (|S| ≤ |P|/α, [Raster2Mesh §4.1]).
Fineness choose_fineness(const SurfaceScale& scale, const Box& bounds, const MeshOptions& options,
                         std::vector<Notice>& notices);

}  // namespace evenmesh
