#include "band/site_parts.h"

#include <algorithm>
#include <limits>

#include "evenmesh/error.h"

namespace evenmesh {

std::size_t SiteVoxels::bytes() const {
  return tiles.bytes() + (x.capacity() + y.capacity() + z.capacity()) * sizeof(float) +
         normal.capacity() * sizeof(PackedNormal) + source.capacity() * sizeof(std::uint32_t);
}

std::vector<BrickItems> bricks_of(const std::vector<std::uint64_t>& sorted_keys) {
  std::vector<BrickItems> bricks;
  for (std::size_t begin = 0, end = 0; begin < sorted_keys.size(); begin = end) {
    while (end < sorted_keys.size() && sorted_keys[end] >> 32 == sorted_keys[begin] >> 32) ++end;
    const auto at = morton_decode(sorted_keys[begin] >> 32);
    bricks.push_back({{at[0] * brick_voxels, at[1] * brick_voxels, at[2] * brick_voxels},
                      std::span(sorted_keys).subspan(begin, end - begin)});
  }
  return bricks;
}

namespace {

// Joins one array of all parts; frees the parts' one after the other.
template <typename Array>
void join_array(std::vector<SitePart>& parts, Array SitePart::*array, Array& joined) {
  std::size_t count = 0;
  for (const SitePart& part : parts) count += (part.*array).size();
  joined.reserve(count);
  for (SitePart& part : parts) {
    joined.insert(joined.end(), (part.*array).begin(), (part.*array).end());
    Array().swap(part.*array);
  }
}

}  // namespace

SiteVoxels join_parts(const VoxelGrid& grid, std::vector<SitePart>& parts, const ExecutionContext& context) {
  std::size_t count = 0;
  for (const SitePart& part : parts) count += part.x.size();
  if (count > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput("more than 4 billion site voxels: lower the resolution");
  SiteVoxels sites;
  sites.grid = grid;
  parallel_tasks(context, 6, [&](std::size_t i) {
    switch (i) {
      case 0:
        join_array(parts, &SitePart::x, sites.x);
        break;
      case 1:
        join_array(parts, &SitePart::y, sites.y);
        break;
      case 2:
        join_array(parts, &SitePart::z, sites.z);
        break;
      case 3:
        join_array(parts, &SitePart::normal, sites.normal);
        break;
      case 4:
        join_array(parts, &SitePart::source, sites.source);
        break;
      default: {
        std::vector<VoxelTile> tiles;
        join_array(parts, &SitePart::tiles, tiles);
        sites.tiles = VoxelTiles(std::move(tiles));
      }
    }
  });
  return sites;
}

}  // namespace evenmesh
