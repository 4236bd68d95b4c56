#pragma once
/// Pixels that are the rays of a grid.

#include <array>
#include <cstdint>

#include "evenmesh/solid.h"
#include "gl/raster_device.h"
#include "grid/sample_set.h"

namespace evenmesh::gl {

/// A rectangle of rays of one axis: those from (p, q) on, see DexelAxis.
struct RayWindow {
  int axis = 0;
  std::uint32_t p = 0, q = 0, width = 0, height = 0;
};

/// The view in which the centres of the pixels are these rays, with the first and the last grid point along them at the
/// depths −1 and 1.
/// @param placement  of the model in the world
/// @param bounds     of the model
RasterView make_view(const Grid& grid, const RayWindow& window, const Affine& placement, const Box& bounds);

}  // namespace evenmesh::gl
