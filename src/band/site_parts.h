#pragma once
/// Sites, piece by piece of the grid.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "band/voxelize.h"
#include "core/parallel.h"
#include "grid/morton.h"

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
SiteVoxels join_parts(const VoxelGrid& grid, std::vector<SitePart>& parts, const ExecutionContext& context);

/// Bricks of 16³ voxels are the unit of work: so their Morton codes have 30 bits.
inline constexpr int brick_bits = 4;
inline constexpr std::int32_t brick_voxels = 1 << brick_bits;  ///< per side
inline std::uint64_t brick_key(const Voxel& brick, std::size_t item) {
  return morton_code(std::uint64_t(brick[0]), std::uint64_t(brick[1]), std::uint64_t(brick[2])) << 32 | item;
}

/// The keys that belong to one brick: what lies in it, in ascending order.
struct BrickItems {
  Voxel corner;  ///< the brick's first voxel
  std::span<const std::uint64_t> keys;
};
std::vector<BrickItems> bricks_of(const std::vector<std::uint64_t>& sorted_keys);

/// Collects what is known of the sites of one brick after the other. A voxel of a brick has a local number of 12 bits:
/// x, y, z, x the lowest four.
template <typename Site>
class BrickSites {
 public:
  static constexpr std::uint32_t local(std::int32_t i, std::int32_t j, std::int32_t k) {
    return static_cast<std::uint32_t>((k << brick_bits | j) << brick_bits | i);
  }
  /// The site of a voxel, which becomes one.
  Site& at(std::uint32_t local) {
    rows_[local >> brick_bits] = static_cast<std::uint16_t>(rows_[local >> brick_bits] | 1u << (local % brick_voxels));
    return sites_[local];
  }
  /// Sites so far.
  std::size_t size() const {
    std::size_t sum = 0;
    for (const std::uint16_t row : rows_) sum += static_cast<std::size_t>(std::popcount(row));
    return sum;
  }
  /// Calls use(i, site) for the i-th of all sites in the order of their tiles, adds the tiles to the part, and forgets
  /// them. @param corner  the brick's first voxel
  template <typename Use>
  void finish(const Voxel& corner, SitePart& part, const Use& use) {
    std::size_t next = 0;
    for (unsigned t = 0; t < 8; ++t) {
      const std::array<unsigned, 3> half{t & 1, t >> 1 & 1, t >> 2};
      VoxelTile tile;
      for (std::size_t a = 0; a < 3; ++a)
        tile.at[a] = static_cast<std::uint16_t>(static_cast<unsigned>(corner[a]) / tile_size + half[a]);
      std::uint64_t any = 0;
      for (unsigned z = 0; z < tile_size; ++z) {
        for (unsigned y = 0; y < tile_size; ++y) {
          const std::size_t row = ((tile_size * half[2] + z) << brick_bits) + tile_size * half[1] + y;
          const unsigned bits = rows_[row] >> (tile_size * half[0]) & 255u;
          tile.layers[z] |= std::uint64_t{bits} << (tile_size * y);
          Site* sites = &sites_[(row << brick_bits) + tile_size * half[0]];
          for (unsigned left = bits; left != 0; left &= left - 1) {
            Site& site = sites[std::countr_zero(left)];
            use(next++, site);
            site = {};
          }
        }
        any |= tile.layers[z];
      }
      if (any != 0) part.tiles.push_back(tile);
    }
    rows_ = {};
  }

 private:
  std::array<std::uint16_t, 1 << (2 * brick_bits)> rows_{};  // by y and z: bit x
  std::vector<Site> sites_ = std::vector<Site>(1 << (3 * brick_bits));
};

/// Calls work(bricks, part) for pieces of neighbouring bricks, in parallel, and joins the parts.
template <typename Work>
SiteVoxels collect_sites(const VoxelGrid& grid, std::span<const BrickItems> bricks, const ExecutionContext& context,
                         const Work& work) {
  constexpr std::size_t per_part = 32;
  std::vector<SitePart> parts((bricks.size() + per_part - 1) / per_part);
  parallel_tasks(context, parts.size(), [&](std::size_t p) {
    work(bricks.subspan(p * per_part, std::min(per_part, bricks.size() - p * per_part)), parts[p]);
  });
  return join_parts(grid, parts, context);
}

}  // namespace evenmesh
