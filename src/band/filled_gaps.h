#pragma once
/// Where the shells of two sheets run into each other.

#include <cstdint>
#include <vector>

#include "band/narrow_band.h"

namespace evenmesh {

/// A connected part of the space between two sheets of surface, or two parts of one, that face each other.
struct FilledGap {
  double width = 0;                  ///< where the sheets come nearest, model units
  unsigned kept_apart = 0;           ///< d of the thickest shell that would not fill it; 0: none does
  Vec3 middle;                       ///< somewhere in the gap
  std::vector<std::uint32_t> sites;  ///< on both of its sides, ascending
};

/// Gaps between sheets that the shell fills, so that the surface is no longer seen from there.
///
/// Where neighbouring voxels have nearest sites that face each other across them, the shell has no border.
/// FeatureCurves look like that in their depth, but there the sites are joined by a short way along the surface; those
/// are left out.
/// @param sites  those that the shell was built from, with normals; their signs do not matter
/// Guarantee: same result for any number of threads; ordered by place. Cost: about 5 ns per voxel of the shell.
std::vector<FilledGap> filled_gaps(const NarrowBand& band, const SiteVoxels& sites,
                                   ExecutionContext& context = ExecutionContext::silent());

}  // namespace evenmesh
