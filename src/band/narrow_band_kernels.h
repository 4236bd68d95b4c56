#pragma once
/// The distance transform of one block of voxels, with SIMD.

#include <array>
#include <cstdint>

#include "band/narrow_band.h"

namespace evenmesh {

/// Voxels per side of a block: two tiles.
inline constexpr unsigned band_block = 16;
inline constexpr unsigned max_band_reach = 20;
/// Rows of sites that bear upon a block, along each axis.
inline constexpr unsigned max_band_window = band_block + 2 * max_band_reach;

/// What the transform of every block adds to keys. A key is a NearestSite's bits; the lesser one wins, by distance,
/// then by the site's z, y, x: the fixed rule for ties costs nothing.
struct BandSteps {
  /// No site within reach along x; with 2 d² added still a positive 32-bit integer.
  static constexpr std::uint32_t none = 1000u << 18;

  unsigned reach = 0;
  std::array<std::uint32_t, 2 * max_band_reach + 1> along_y{}, along_z{};  ///< by site − voxel + reach
  /// Keys of the 16 voxels of a row for a site at bit b of its window.
  alignas(64) std::array<std::array<std::uint32_t, band_block>, max_band_window> along_x{};

  explicit BandSteps(unsigned d);
};

/// Sites around a block, and how much of the block belongs to the grid.
struct BandWindow {
  /// By (z + d) · (16 + 2d) + (y + d): bit x + d is set when voxel (x, y, z), counted from the block's corner, is a
  /// site.
  std::array<std::uint64_t, max_band_window * max_band_window> rows{};
  std::array<unsigned, 3> size{band_block, band_block, band_block};
};

/// The shell's voxels of a block, by tile; x is the lowest bit of a tile's index.
struct BandTileOut {
  std::array<std::uint64_t, 8> layers;
  unsigned count;
  std::array<NearestSite, 512 + 8> nearest;  ///< some room behind the end for whole vectors
};
using BandBlockOut = std::array<BandTileOut, 8>;

/// Nearest sites of the 16³ voxels of a block: along x, then along y, then along z.
void transform_block(const BandSteps& steps, const BandWindow& window, BandBlockOut& out);

}  // namespace evenmesh
