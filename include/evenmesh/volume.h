#pragma once
/// Values on some of the voxels of a cubic grid.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Voxel (i, j, k) has its centre at origin + side · (i, j, k). Voxels that are not listed have the background's value.
struct SparseVolume {
  std::string name;
  Vec3 origin;           ///< centre of voxel (0, 0, 0), model units
  double side = 1;       ///< of a voxel, model units
  float background = 0;  ///< where no voxel is
  std::vector<std::array<std::int32_t, 3>> voxels{};
  std::vector<float> values{};  ///< one per voxel
};

}  // namespace evenmesh
