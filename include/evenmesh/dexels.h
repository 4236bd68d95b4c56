#pragma once
/// Solids as rays see them: where the edges of a grid cross their surface.

#include <array>
#include <cstdint>
#include <vector>

#include "evenmesh/mesh.h"
#include "evenmesh/shape.h"

namespace evenmesh {

/// A tri-dexel solid. Grid point (i, j, k) lies at origin + spacing · (i, j, k); the outermost points are outside.
struct Dexels {
  /// Where a grid edge, from a point one step up along its axis, leaves or enters the solid.
  struct Crossing {
    std::array<std::uint16_t, 3> point{};  ///< lower end of the edge
    std::uint8_t axis = 0;                 ///< 0, 1, 2
    bool leaves = false;                   ///< the lower end is inside
    float t = 0;                           ///< how far along the edge, [0, 1]
    std::uint32_t normal = 0;  ///< unit, outward: octahedral map, 16 bits each, 32767 + 32767·(x, y)/(|x|+|y|+|z|)
    friend bool operator==(const Crossing&, const Crossing&) = default;
  };
  Vec3 origin;
  double spacing = 1;                   ///< model units
  std::array<std::uint32_t, 3> size{};  ///< grid points along each axis, 3 to 8,200
  std::vector<Crossing> crossings;      ///< at most one per edge; all edges whose ends differ
};

/// The solid. Sampled on other grids through the surface of its crossings, which keeps edges sharp.
/// @throws UnusableInput  crossings beyond the grid, twice on an edge, or that do not agree on what is inside
Shape shape_from_dexels(const Dexels& dexels, std::string name = "dexels");

}  // namespace evenmesh
