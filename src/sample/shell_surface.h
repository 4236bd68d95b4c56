#pragma once
/// The two sides of a shell, drawn onto the surface in its middle.

#include <cstdint>
#include <vector>

#include "sample/sample_set.h"
#include "sample/shell.h"

namespace evenmesh {

/// The border between the voxels of a shell and those outside, as samples on the grid of the voxels' centres.
///
/// The shell is the solid: `samples` bound it and link up as those of any solid. But each sample's position is moved
/// along the surface normal onto the surface in the middle of the shell, and its area is counted there.
struct ShellSurface {
  SampleSet samples;                ///< normals point out of the shell; source: that of the site
  std::vector<std::uint32_t> site;  ///< nearest site of each sample, an index into the SiteVoxels
  /// Cosine between the way from the surface to the sample's place on the border and the surface's normal: 1 in front
  /// of the surface, −1 behind it, about 0 around its rim.
  std::vector<float> facing;
};

/// @param sites  those that the shell was built from, with normals
/// Guarantee: same bytes for any number of threads. Cost: O(shell).
/// @throws UnusableInput  the shell is empty
ShellSurface shell_surface(const Shell& shell, const SiteVoxels& sites, Run& run);

/// Normals of sites that have none: of the plane through the sites' points within `radius` voxels, both ways round
/// (their sign means nothing). Cost: O(sites · radius³).
void estimate_normals(SiteVoxels& sites, unsigned radius, Run& run);

}  // namespace evenmesh
