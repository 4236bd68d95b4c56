#pragma once
/// The two sides of a shell, drawn onto the surface in its middle.

#include <cstdint>
#include <span>
#include <vector>

#include "band/narrow_band.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// The border between the voxels of a shell and those outside, as samples on the grid of the voxels' centres.
///
/// The shell is the solid: `samples` bound it and link up as those of any solid. They lie where the edges leave the
/// shell's thickness around the tangent plane of the nearest site, so over smooth surface they are as even as samples
/// of the surface itself.
struct BandSurface {
  SampleSet samples;                ///< normals point out of the shell; source: that of the site
  std::vector<std::uint32_t> site;  ///< nearest site of each sample, an index into the SiteVoxels
  /// Cosine between the way from the surface to the sample and the surface's normal: 1 in front of the surface, −1
  /// behind it, about 0 around its rim.
  std::vector<float> facing;
};

/// @param sites  those that the shell was built from, with normals
/// Guarantee: same bytes for any number of threads. Cost: O(shell).
/// @throws UnusableInput  the shell is empty
BandSurface band_surface(const NarrowBand& band, const SiteVoxels& sites, ExecutionContext& context);

/// |facing| from here on is clearly in front or behind.
inline constexpr float clearly_facing = 0.5f;

/// Some samples of a shell's surface, moved along the normals onto the surface in the middle of the shell, to within a
/// voxel of their sites.
/// @param samples  a subset of surface.samples
/// @param index    where each of them is in surface.samples
SampleSet drawn_onto_surface(SampleSet samples, std::span<const std::uint32_t> index, const BandSurface& surface,
                             const SiteVoxels& sites, ExecutionContext& context);

}  // namespace evenmesh
