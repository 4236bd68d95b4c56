#pragma once
/// Invariants of sets of voxels, and the voxels a triangle touches by brute force, shared by the tests of this folder.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "band/narrow_band.h"
#include "band/triangle_cells.h"
#include "band/voxelize.h"
#include "core/random.h"
#include "grid/morton.h"
#include "grid/sample_checks.h"

namespace evenmesh {

/// Voxels (i, j, k) = [i, i + 1] × … from the origin on.
inline VoxelGrid unit_voxels(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz) {
  return {{0, 0, 0}, 1.0, {nx, ny, nz}};
}

/// Calls use(voxel) for all voxels of a grid.
template <typename Use>
void for_all_voxels(const VoxelGrid& grid, const Use& use) {
  Voxel v{};
  for (v[2] = 0; v[2] < static_cast<std::int32_t>(grid.size[2]); ++v[2])
    for (v[1] = 0; v[1] < static_cast<std::int32_t>(grid.size[1]); ++v[1])
      for (v[0] = 0; v[0] < static_cast<std::int32_t>(grid.size[0]); ++v[0]) use(v);
}

/// The voxels of a set in order.
inline std::vector<Voxel> voxels_of(const VoxelTiles& tiles) {
  std::vector<Voxel> voxels;
  for (const VoxelTile& tile : tiles)
    for_each_voxel(tile, [&](unsigned x, unsigned y, unsigned z) {
      const Voxel c = tile.corner();
      voxels.push_back({c[0] + std::int32_t(x), c[1] + std::int32_t(y), c[2] + std::int32_t(z)});
    });
  return voxels;
}

/// Tiles are not empty, sorted and found by their coordinates; numbers count up in order; all voxels are in the grid.
inline void expect_well_formed(const VoxelTiles& tiles, const VoxelGrid& grid) {
  std::uint64_t next = 0, last_code = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    const VoxelTile& tile = tiles[t];
    const std::uint64_t code = morton_code(tile.at[0], tile.at[1], tile.at[2]);
    EXPECT_TRUE(t == 0 || last_code < code);
    last_code = code;
    EXPECT_GT(tile.count(), 0u);
    EXPECT_EQ(tile.begin, next);
    EXPECT_EQ(tiles.find(tile.at[0], tile.at[1], tile.at[2]), &tile);
    next += tile.count();
  }
  EXPECT_EQ(tiles.voxels(), next);
  std::size_t wrong = 0, outside = 0;
  const std::vector<Voxel> voxels = voxels_of(tiles);
  EXPECT_EQ(voxels.size(), next);
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    if (tiles.number(voxels[i]) != i) ++wrong;
    if (!grid.contains(voxels[i])) ++outside;
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(outside, 0u);
}

inline void expect_well_formed(const SiteVoxels& sites) {
  expect_well_formed(sites.tiles, sites.grid);
  EXPECT_EQ(sites.tiles.voxels(), sites.size());
  EXPECT_EQ(sites.y.size(), sites.size());
  EXPECT_EQ(sites.z.size(), sites.size());
  EXPECT_TRUE(sites.normal.empty() || sites.normal.size() == sites.size());
  EXPECT_TRUE(sites.source.empty() || sites.source.size() == sites.size());
}

inline bool same_tiles(const VoxelTiles& a, const VoxelTiles& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const VoxelTile& u, const VoxelTile& v) {
    return u.begin == v.begin && u.layers == v.layers && u.before == v.before && u.at == v.at;
  });
}

inline void expect_same(const SiteVoxels& a, const SiteVoxels& b) {
  EXPECT_TRUE(same_tiles(a.tiles, b.tiles));
  EXPECT_TRUE(same_bytes(a.x, b.x) && same_bytes(a.y, b.y) && same_bytes(a.z, b.z));
  EXPECT_TRUE(same_bytes(a.normal, b.normal));
  EXPECT_TRUE(same_bytes(a.source, b.source));
  EXPECT_EQ(a.outside, b.outside);
}

/// The surface point of site i in voxel v.
inline Vec3 surface_point(const SiteVoxels& sites, const Voxel& v, std::size_t i) {
  return sites.grid.center(v) + Vec3{sites.x[i], sites.y[i], sites.z[i]};
}

/// Whether a closed cell and a closed triangle are separated along none of the thirteen axes; everything in integers.
/// @param bits  the cell's side is 2^bits
inline bool touches(const LatticeTriangle& triangle, const Voxel& cell, int bits) {
  using Wide = __int128;
  using Vector = std::array<std::int64_t, 3>;
  std::vector<Vector> axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto minus = [](const LatticePoint& p, const LatticePoint& q) {
    return Vector{std::int64_t{p[0]} - q[0], std::int64_t{p[1]} - q[1], std::int64_t{p[2]} - q[2]};
  };
  const auto times = [](const Vector& p, const Vector& q) {
    return Vector{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  };
  const Vector ab = minus(triangle[1], triangle[0]), bc = minus(triangle[2], triangle[1]),
               ca = minus(triangle[0], triangle[2]);
  for (const Vector& edge : {ab, bc, ca})
    for (int a = 0; a < 3; ++a) axes.push_back(times(edge, axes[std::size_t(a)]));
  axes.push_back(times(ab, bc));
  for (const Vector& axis : axes) {
    Wide lo = 0, hi = 0, first = 0, last = 0;  // of the cell, of the triangle
    for (std::size_t a = 0; a < 3; ++a) {
      const Wide low = Wide{axis[a]} * (std::int64_t{cell[a]} << bits), up = low + (Wide{axis[a]} << bits);
      lo += std::min(low, up), hi += std::max(low, up);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      Wide at = 0;
      for (std::size_t a = 0; a < 3; ++a) at += Wide{axis[a]} * triangle[i][a];
      first = i == 0 ? at : std::min(first, at), last = i == 0 ? at : std::max(last, at);
    }
    if (first > hi || last < lo) return false;
  }
  return true;
}

}  // namespace evenmesh
