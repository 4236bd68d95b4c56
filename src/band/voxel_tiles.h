#pragma once
/// Sets of voxels as sparse tiles of 8³ bits.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "band/voxel_grid.h"

namespace evenmesh {

/// Voxels per side of a tile.
inline constexpr unsigned tile_size = 8;

/// Up to 8³ voxels of a set, numbered by z, then y, then x.
struct VoxelTile {
  std::uint64_t begin = 0;                ///< number of the tile's first voxel in the whole set
  std::array<std::uint64_t, 8> layers{};  ///< by z: bit 8y + x is set when voxel (x, y, z) of the tile is in the set
  std::array<std::uint16_t, 8> before{};  ///< voxels in the layers below, see count_layers()
  std::array<std::uint16_t, 3> at{};      ///< tile coordinates: voxel / 8

  static std::uint64_t bit(unsigned x, unsigned y) { return std::uint64_t{1} << (8 * y + x); }
  bool contains(unsigned x, unsigned y, unsigned z) const { return (layers[z] & bit(x, y)) != 0; }
  /// How many voxels of the tile stand before (x, y, z).
  unsigned rank(unsigned x, unsigned y, unsigned z) const {
    return before[z] + static_cast<unsigned>(std::popcount(layers[z] & (bit(x, y) - 1)));
  }
  unsigned count() const { return before[7] + static_cast<unsigned>(std::popcount(layers[7])); }
  void count_layers() {
    for (std::size_t z = 1; z < 8; ++z)
      before[z] = static_cast<std::uint16_t>(before[z - 1] + std::popcount(layers[z - 1]));
  }
  /// Grid voxel of the tile's first corner.
  Voxel corner() const {
    return {at[0] * std::int32_t{tile_size}, at[1] * std::int32_t{tile_size}, at[2] * std::int32_t{tile_size}};
  }
};

/// Calls use(x, y, z) for the voxels of a tile, in order.
template <typename Use>
void for_each_voxel(const VoxelTile& tile, const Use& use) {
  for (unsigned z = 0; z < tile_size; ++z)
    for (std::uint64_t left = tile.layers[z]; left != 0; left &= left - 1) {
      const auto at = static_cast<unsigned>(std::countr_zero(left));
      use(at % tile_size, at / tile_size, z);
    }
}

/// Non-empty tiles, sorted by the Morton code of their coordinates (x the lowest bit), found by coordinates at once.
///
/// Memory: 96 bytes per tile; a directory of 4 bytes for every 64³ voxels of the grid and 2 KiB for each of those that
/// hold a tile.
class VoxelTiles {
 public:
  VoxelTiles() = default;
  /// @param tiles  sorted; begin and before are set here
  explicit VoxelTiles(std::vector<VoxelTile> tiles);

  std::size_t size() const { return tiles_.size(); }
  const VoxelTile& operator[](std::size_t i) const { return tiles_[i]; }
  auto begin() const { return tiles_.begin(); }
  auto end() const { return tiles_.end(); }
  /// Voxels of the set.
  std::uint64_t voxels() const { return tiles_.empty() ? 0 : tiles_.back().begin + tiles_.back().count(); }
  std::size_t bytes() const;

  /// The tile at the given tile coordinates, or nullptr where none is; any coordinates will do. Cost: two loads.
  const VoxelTile* find(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const std::int32_t group_i = i >> 3, group_j = j >> 3, group_k = k >> 3;
    if (static_cast<std::uint32_t>(group_i) >= groups_[0] || static_cast<std::uint32_t>(group_j) >= groups_[1] ||
        static_cast<std::uint32_t>(group_k) >= groups_[2])
      return nullptr;
    const std::uint32_t group =
        directory_[(std::size_t(group_k) * groups_[1] + std::size_t(group_j)) * groups_[0] + std::size_t(group_i)];
    if (group == 0) return nullptr;
    const auto in_group = static_cast<std::uint32_t>((k & 7) << 6 | (j & 7) << 3 | (i & 7));
    const std::uint32_t tile = entries_[group - 1][in_group];
    return tile == 0 ? nullptr : &tiles_[tile - 1];
  }
  /// The tile that holds a voxel of the grid.
  const VoxelTile* tile_of(const Voxel& v) const { return find(v[0] >> 3, v[1] >> 3, v[2] >> 3); }
  bool contains(const Voxel& v) const {
    const VoxelTile* tile = tile_of(v);
    return tile != nullptr && tile->contains(v[0] & 7, v[1] & 7, v[2] & 7);
  }
  /// The number of a voxel in the set, if it belongs to it. Cost: a few nanoseconds.
  std::optional<std::uint64_t> number(const Voxel& v) const {
    const VoxelTile* tile = tile_of(v);
    const unsigned x = v[0] & 7, y = v[1] & 7, z = v[2] & 7;
    if (tile == nullptr || !tile->contains(x, y, z)) return std::nullopt;
    return tile->begin + tile->rank(x, y, z);
  }

 private:
  using Group = std::array<std::uint32_t, 512>;  // tile + 1, by tile coordinates within the group; 0: none
  std::vector<VoxelTile> tiles_;
  std::array<std::uint32_t, 3> groups_{};
  std::vector<std::uint32_t> directory_;  // group + 1, by group coordinates; 0: none
  std::vector<Group> entries_;
};

}  // namespace evenmesh
