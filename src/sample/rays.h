#pragma once
/// From hits along one ray to the runs of the solid.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "evenmesh/shape.h"
#include "grid/tri_dexel.h"

namespace evenmesh {

/// Where a ray meets a triangle.
struct RayHit {
  std::uint32_t source = 0;
  float t = 0;
  std::uint16_t cell = 0;
  std::int8_t step = 0;    ///< change of the winding number along the ray, ±1
  bool synthetic = false;  ///< moved onto the bounds
};

/// Two crossings of a ray less than a cell apart: a wall of the solid between them, or a gap.
struct NearPair {
  RayHit from, to;
  bool gap = false;
  bool sampled = false;   ///< a grid point happens to lie between them; without they were left out
  std::uint32_t ray = 0;  ///< for the caller: resolve_ray() does not know it
};

/// What resolving rays had to do.
struct RayCounts {
  std::size_t unresolved = 0;  ///< crossings left out because one cell held several
  std::vector<NearPair> near;  ///< those, and others as near to each other
  bool capped = false;         ///< a crossing on the bounds remained
};

/// Sorts the hits along the ray. Cost: linear for the few hits of a usual ray.
void sort_hits(std::span<RayHit> hits);

/// Appends the crossings at which inside changes, at most one per cell, to `out`; hits must be sorted.
/// @param winding  what counts as inside; of closed meshes that face outward the number rises where the ray enters
/// Rays whose winding number does not return to 0 are read by parity, less an unmatched hit.
void resolve_ray(std::span<RayHit> hits, Winding winding, std::vector<DexelCrossing>& out, RayCounts& counts);

/// The thin walls and gaps among pairs whose rays count as those of a slab do: p · 8 + (q & 7).
/// @param normal_of  of a hit's source: unit, of either orientation
std::vector<ThinSpot> thin_spots(std::span<const NearPair> pairs, const Grid& grid, int axis, std::uint32_t slab,
                                 const std::function<Vec3(std::uint32_t)>& normal_of);

}  // namespace evenmesh
