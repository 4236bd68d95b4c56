#pragma once
/// The cubic voxel grid that shells live on.

#include <array>
#include <cstddef>
#include <cstdint>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Which voxel: its number along each axis. Negative, or beyond the grid: no voxel of it.
using Voxel = std::array<std::int32_t, 3>;

/// Voxel (i, j, k) is the closed cube between origin + h · (i, j, k) and origin + h · (i + 1, j + 1, k + 1).
struct VoxelGrid {
  Vec3 origin;
  double side = 1;                      ///< h, side of a voxel, model units
  std::array<std::uint32_t, 3> size{};  ///< voxels along each axis, at most 8,192 and the margins

  Vec3 center(const Voxel& v) const { return origin + side * Vec3{v[0] + 0.5, v[1] + 0.5, v[2] + 0.5}; }
  bool contains(const Voxel& v) const {
    const auto within = [&](std::size_t a) { return v[a] >= 0 && static_cast<std::uint32_t>(v[a]) < size[a]; };
    return within(0) && within(1) && within(2);
  }
  /// Voxels of the whole grid, most of them never touched.
  std::uint64_t voxels() const { return std::uint64_t{size[0]} * size[1] * size[2]; }
};

/// Grid around `bounds` with `resolution` voxels along the longest side and `margin` voxels around it.
///
/// The bounds' lower corner lies in the centre of voxel (margin, margin, margin), so round coordinates fall onto
/// centres of voxels, where they touch one, and not onto faces, where they touch two.
/// @param resolution  1 to 8,192
/// @param margin      voxels, 1 to 64; d + 1 for a shell that reaches d voxels
/// @throws InvalidInput  the bounds are empty, not finite or a point; resolution or margin is out of range
VoxelGrid make_voxel_grid(const Box& bounds, std::size_t resolution, unsigned margin);

}  // namespace evenmesh
