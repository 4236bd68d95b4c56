#pragma once
/// Where the solid of a field is that knows no intervals.

#include "evenmesh/mesh.h"
#include "shape/field.h"

namespace evenmesh {

/// Whether f encloses anything: boxes of several sizes are tried.
bool knows_intervals(const Field& field);

/// Box around the solid f < 0, a few per cent larger than it, by asking at points: nothing is proved.
///
/// First on grids over cubes around the origin, with half sides from 2^-10 to 2^13; then, finer and finer, where the
/// solid was seen. At last around the box found, by the 140th part of its sides, and on its faces, by the 512th: where
/// the solid goes on, the box grows.
/// The solid is seen when a ball of a tenth of its distance from the origin fits into it, and its parts when they are
/// connected to what was seen by bridges thicker than the 512th part of it, or so near and thick that the last grids
/// meet them. What floats farther away than eight times the solid's reach is taken for another thing when the field is
/// negative beyond ±1024, too; otherwise it counts.
/// Cost: about 8 million evaluations, in some dozens of batches.
/// @throws UnusableInput  f < 0 everywhere far away, or nowhere seen
Box probed_bounds(const Field& field);

}  // namespace evenmesh
