#pragma once
/// What shells enclose.

#include "band/sheets.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// The sites around the outer border of a shell, on the same grid.
SiteVoxels outer_border(const BandSurface& surface, const Sheets& outer, const VoxelGrid& grid,
                        ExecutionContext& context);

/// The inner side of a shell around such a border, turned around: the border of what the shell encloses.
SampleSet enclosed_by(const BandSurface& surface, ExecutionContext& context);

/// A solid with its narrow gaps filled, as far as no ball of `reach` cells fits between the parts on its way in from
/// outside; the first 2·reach cells of a gap behind the last such ball stay open, so that no edge is rounded. Elsewhere
/// samples stay as they are; none has a source.
/// @param solid  not weighted
/// @param reach  cells of the grid, 1 to 10
/// Guarantee: closed as the solid is; same bytes for any number of threads. Cost: two shells, of reach and of twice
/// that.
SampleSet narrow_gaps_filled(const SampleSet& solid, unsigned reach, ExecutionContext& context);

}  // namespace evenmesh
