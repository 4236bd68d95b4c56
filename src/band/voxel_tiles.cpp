#include "band/voxel_tiles.h"

#include <algorithm>

namespace evenmesh {

VoxelTiles::VoxelTiles(std::vector<VoxelTile> tiles) : tiles_(std::move(tiles)) {
  if (tiles_.empty()) return;
  std::uint64_t sum = 0;
  for (VoxelTile& tile : tiles_) {
    tile.count_layers();
    tile.begin = sum;
    sum += tile.count();
    for (std::size_t a = 0; a < 3; ++a) groups_[a] = std::max<std::uint32_t>(groups_[a], tile.at[a] / 8u + 1);
  }
  directory_.resize(std::size_t{groups_[0]} * groups_[1] * groups_[2]);
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    const auto& at = tiles_[t].at;
    std::uint32_t& group = directory_[(std::size_t{at[2] / 8u} * groups_[1] + at[1] / 8u) * groups_[0] + at[0] / 8u];
    if (group == 0) {
      entries_.emplace_back();
      group = static_cast<std::uint32_t>(entries_.size());
    }
    entries_[group - 1][at[2] % 8u * 64 + at[1] % 8u * 8 + at[0] % 8u] = static_cast<std::uint32_t>(t + 1);
  }
}

std::size_t VoxelTiles::bytes() const {
  return tiles_.capacity() * sizeof(VoxelTile) + directory_.capacity() * sizeof(std::uint32_t) +
         entries_.capacity() * sizeof(Group);
}

}  // namespace evenmesh
