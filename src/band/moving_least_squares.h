#pragma once
/// From scattered sites to a surface without gaps.

#include "band/narrow_band.h"
#include "band/voxelize.h"

namespace evenmesh {

/// Normals of sites that have none: of the plane through the sites' points within `radius` voxels, both ways round
/// (their sign means nothing). Cost: O(sites · radius³).
void estimate_normals(SiteVoxels& sites, unsigned radius, ExecutionContext& context);

/// The voxels that a smooth surface through scattered sites touches, within the shell that bridges their gaps.
///
/// At each voxel the sites within 2.5 spacings, weighted by distance, give a plane; voxels that it passes through are
/// sites of the result, with their closest point on it and its normal. Noise below a spacing is averaged out. Where all
/// sites lie to one side the surface ends, about half a spacing behind the last of them.
///
/// @param sparse   sites with normals
/// @param oriented  the normals' sign can be trusted: sites that face the other way belong to another sheet
/// @param shell    around them, wide enough to close gaps
/// @param spacing  of the points, model units, > 0
/// Guarantee: same bytes for any number of threads. Cost: about a microsecond per voxel of the shell near the surface.
/// The weighted planes are those of Alexa et al., Computing and rendering point set surfaces, TVCG 9(1), 2003, without
/// their iteration.
SiteVoxels moving_least_squares(const SiteVoxels& sparse, const NarrowBand& band, double spacing, bool oriented,
                                ExecutionContext& context);

}  // namespace evenmesh
