#pragma once
/// Sites, piece by piece of the grid.

#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "sample/voxelize.h"

namespace evenmesh {

/// Sites of some neighbouring tiles, in their final order. Arrays that are not used stay empty in all parts.
struct SitePart {
  std::vector<VoxelTile> tiles;
  std::vector<float> x, y, z;
  std::vector<PackedNormal> normal;
  std::vector<std::uint32_t> source;
};

/// The sites of all parts, which are used up.
/// @throws InvalidInput  more than 4 billion sites
SiteVoxels join_parts(const VoxelGrid& grid, std::vector<SitePart>& parts, const Run& run);

/// A run of the sorted keys that share their upper 32 bits: the Morton code of a piece of the grid. The lower 32 bits
/// say what lies in it.
struct KeyRun {
  std::uint32_t code;
  std::size_t begin, end;
};
std::vector<KeyRun> runs_of(const std::vector<std::uint64_t>& sorted_keys);

}  // namespace evenmesh
