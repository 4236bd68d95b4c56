#include "band/voxel_grid.h"

#include <cmath>
#include <string>

#include "evenmesh/error.h"

namespace evenmesh {
namespace {

constexpr std::size_t max_resolution = 8192;
constexpr unsigned max_margin = 64;

}  // namespace

VoxelGrid make_voxel_grid(const Box& bounds, std::size_t resolution, unsigned margin) {
  if (bounds.empty() || !is_finite(bounds.lo) || !is_finite(bounds.hi) || !(bounds.longest_side() > 0))
    throw InvalidInput("the bounds are empty or not finite: give a box with finite corners and at least one side > 0");
  if (resolution < 1 || resolution > max_resolution)
    throw InvalidInput("resolution " + std::to_string(resolution) + " is out of range: choose 1 to 8192");
  if (margin < 1 || margin > max_margin)
    throw InvalidInput("a margin of " + std::to_string(margin) + " voxels is out of range: choose 1 to 64");
  VoxelGrid grid;
  grid.side = bounds.longest_side() / static_cast<double>(resolution);
  if (!(grid.side > 0) || !std::isfinite(1.0 / grid.side))
    throw InvalidInput("the bounds are too small for a grid: scale the model up");
  for (int a = 0; a < 3; ++a) {
    grid.origin[a] = bounds.lo[a] - (margin + 0.5) * grid.side;
    // The upper face may round onto the next voxel's: that one counts as touched.
    const double top = (bounds.hi[a] - bounds.lo[a]) / grid.side + 0.5 + 1e-6;
    grid.size[static_cast<std::size_t>(a)] = static_cast<std::uint32_t>(std::floor(top)) + 1 + 2 * margin;
  }
  return grid;
}

}  // namespace evenmesh
