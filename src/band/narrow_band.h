#pragma once
/// The shell around a surface: the voxels near it, with their exact distances to the nearest site.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "band/voxel_tiles.h"
#include "band/voxelize.h"
#include "evenmesh/execution_context.h"

namespace evenmesh {

/// What the transform says of one voxel: where its nearest site is, in voxels, and how far.
struct NearestSite {
  std::uint32_t bits = 0;  ///< from the top: squared distance, then dz, dy, dx, six bits each, with 32 added

  std::uint32_t squared_distance() const { return bits >> 18; }
  /// From the voxel to the site.
  Voxel offset() const {
    const auto at = [this](unsigned shift) { return static_cast<std::int32_t>(bits >> shift & 63) - 32; };
    return {at(0), at(6), at(12)};
  }
  Voxel site(const Voxel& voxel) const {
    const Voxel by = offset();
    return {voxel[0] + by[0], voxel[1] + by[1], voxel[2] + by[2]};
  }
};

/// Voxels whose centres lie within `reach` voxels of a site voxel's centre, site voxels included.
///
/// A voxel of the shell has a number, tile.begin + tile.rank(x, y, z) or tiles().number(voxel), for arrays of the later
/// stages; in a tile they follow each other in the order of for_each_voxel().
class NarrowBand {
 public:
  const VoxelGrid& grid() const { return grid_; }
  /// d, half the thickness of the shell in voxels.
  unsigned reach() const { return reach_; }
  const VoxelTiles& tiles() const { return tiles_; }
  /// Voxels of the shell.
  std::uint64_t size() const { return tiles_.voxels(); }
  /// Memory of the tiles and their voxels.
  std::size_t bytes() const {
    return tiles_.bytes() + nearest_.capacity() * sizeof(void*) + size() * sizeof(NearestSite);
  }

  /// The voxels of tile i, in order.
  std::span<const NearestSite> nearest(std::size_t i) const { return {nearest_[i], tiles_[i].count()}; }
  /// A voxel's nearest site, or nullptr outside the shell. Cost: a few nanoseconds.
  const NearestSite* find(const Voxel& v) const {
    const VoxelTile* tile = tiles_.tile_of(v);
    const unsigned x = v[0] & 7, y = v[1] & 7, z = v[2] & 7;
    if (tile == nullptr || !tile->contains(x, y, z)) return nullptr;
    return nearest_[static_cast<std::size_t>(tile - &tiles_[0])] + tile->rank(x, y, z);
  }

 private:
  friend NarrowBand build_narrow_band(const SiteVoxels& sites, unsigned reach, ExecutionContext& context);

  VoxelGrid grid_;
  unsigned reach_ = 0;
  VoxelTiles tiles_;
  std::vector<const NearestSite*> nearest_;             // by tile, into the pieces
  std::vector<std::unique_ptr<NearestSite[]>> pieces_;  // as they came from the loop: nothing is copied
};

/// Euclidean distance transform in a narrow band.
///
/// Guarantee: squared distances are exact; of several nearest sites a voxel gets the one that comes first by z, then y,
/// then x; same bytes for any number of threads and any instruction set. Voxels outside the grid are left out.
/// Cost: O(d · shell) vector operations; 4 bytes per voxel of the shell and 104 per tile of 8³, nothing per voxel of
/// the grid.
/// @param reach  d, voxels, 1 to 20
/// @throws InvalidInput  d is out of range
/// Based on [NBEDT §3.1]; the separable transform itself is that of Saito, Toriwaki, New algorithms for Euclidean
/// distance transformation of an n-dimensional digitized picture with applications, Pattern Recognition 27(11), 1994.
NarrowBand build_narrow_band(const SiteVoxels& sites, unsigned reach,
                             ExecutionContext& context = ExecutionContext::silent());

/// The index of a voxel's nearest site in the arrays of `sites`, from which the shell was built. Cost: a few
/// nanoseconds.
std::uint32_t site_index(const SiteVoxels& sites, const Voxel& voxel, NearestSite nearest);

}  // namespace evenmesh
