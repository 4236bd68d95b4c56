#pragma once
/// Where the surface is: samples of a shape's surface on a grid.

#include "core/parallel.h"
#include "evenmesh/shape.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// Samples the surface of `shape` on all edges of `grid`.
///
/// Guarantee: the samples are exactly the grid edges whose ends differ in one sign grid (never stored), so they bound a
/// solid; same bits for any number of threads. Cost: O(samples + triangles), or O(samples) evaluations of a field.
/// @throws UnusableInput  when no grid edge crosses the surface
/// Based on [Raster2Mesh §4.1]; edge rules by simulation of simplicity (Edelsbrunner, Mücke 1990).
SampleSet sample_shape(const Shape& shape, const Grid& grid, ExecutionContext& context = ExecutionContext::silent());

}  // namespace evenmesh
