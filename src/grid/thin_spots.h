#pragma once
/// Walls and gaps that lie between two neighbouring grid points, where no sample tells of them.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Where a ray passes a wall of the solid, or a gap in it, in less than a cell: within one grid edge, both crossings
/// were left out.
struct ThinSpot {
  Vec3 place;           ///< half way through
  float thickness = 0;  ///< across the wall or gap, model units
  float area = 0;       ///< of one of its sides that the spot stands for, see sample_area(); model units squared
  bool gap = false;
  bool sampled = false;  ///< a grid point happens to lie between its sides
};

/// The spot between two neighbouring crossings of a ray; none where they belong to one side of the surface, that the
/// ray grazes, and of walls thinner than 0.005 cells, which are two surfaces in one place.
/// @param normals  unit, of either orientation
std::optional<ThinSpot> thin_spot(const Vec3& from, const Vec3& to, const Vec3& from_normal, const Vec3& to_normal,
                                  int axis, double spacing, bool gap);

/// Those of the spots that make a face as wide as a brick: without those along knife edges and at tips, and without
/// gaps between parts that touch.
std::vector<ThinSpot> wide_spots(const std::vector<ThinSpot>& spots, const Vec3& origin, double spacing);

/// What spots have in common. Lengths in model units.
struct ThinParts {
  double area = 0;       ///< of one side
  double thickness = 0;  ///< median, by area
  double least = 0;      ///< a tenth of the area is thinner
  bool gaps = false;     ///< most of the area belongs to gaps
  std::size_t parts = 0;
  Box largest;  ///< around the part with the largest area
};

/// @param reach  spots nearer than about this belong to one part, model units
ThinParts thin_parts(const std::vector<ThinSpot>& spots, double reach);

}  // namespace evenmesh
