#pragma once
/// Gaps of a sampled solid that are too narrow for its grid or its mesh, filled in places.

#include <span>
#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"
#include "topology/balls.h"

namespace evenmesh {

/// A solid after filling.
struct FilledSolid {
  SampleSet samples;
  std::vector<Vec3> points;  ///< of the grid, that are inside now
};

/// Half the width of the gaps that a place of this radius fills, grid spacings: half the place's radius, 2 to 6.
int closing_radius(double radius, double spacing);

/// Closes the solid by balls within each place: a point outside is filled where no empty ball of the closing radius
/// reaches it. Where the grid is still ambiguous then, as at walls of one point, the cubes there are filled, too.
/// Narrow gaps and tunnels, holes of walls that the grid sees as sieves, and bodies that touch grow together; beside
/// convex surface nothing is added, and what is there stays: crossings whose two ends keep their signs are left alone.
///
/// What is new weighs what the surface around it does, area for area; the outermost grid points stay outside.
/// Guarantee: the samples bound a solid, in the order a SampleSet promises; nothing is filled farther from the solid
/// than the closing radius; same bits for any number of threads. Cost: O(samples) for copying, 0.1 to 3 ms for every
/// brick near a place.
FilledSolid fill_gaps(const SampleSet& samples, std::span<const Ball> places, ExecutionContext& context);

}  // namespace evenmesh
