#pragma once
/// Solids as runs along the rays of three directions.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "grid/sample_set.h"

namespace evenmesh {

/// Where a ray enters or leaves the solid.
struct DexelCrossing {
  std::uint32_t source =
      0;        ///< triangle of the input mesh, or number of a normal; of a neighbouring crossing when `made`
  float t = 0;  ///< position within the cell, [0, 1)
  std::uint16_t cell = 0;  ///< grid point just below the crossing, index along the ray
  bool enters = false;     ///< the grid point above is inside, the one below outside
  bool synthetic = false;  ///< no triangle is here: put by vote or by the bounds, normal along the axis
};

/// Eight neighbouring rows of rays; the unit of parallel work. CSR over its rays, crossings sorted by cell.
struct DexelSlab {
  std::uint32_t first = 0;           ///< lowest p that has a ray here, see DexelAxis
  std::vector<std::uint32_t> begin;  ///< (p - first) * 8 + (q & 7) → first crossing; one entry more than rays
  std::vector<DexelCrossing> crossings;

  std::size_t rays() const { return begin.empty() ? 0 : begin.size() - 1; }
};

/// The rays of one axis. A ray is named by its grid indices p and q on the two other axes, p's axis the lower one.
struct DexelAxis {
  std::vector<DexelSlab> slabs;  ///< slab of row q: q / 8

  /// Crossings of one ray, sorted; at most one per cell, entering and leaving in turn.
  std::span<const DexelCrossing> ray(std::uint32_t p, std::uint32_t q) const;
};

inline constexpr std::array<int, 3> dexel_p_axis{1, 0, 0}, dexel_q_axis{2, 2, 1};

/// A solid: all crossings with the rays of the three directions of one grid.
struct TriDexel {
  Grid grid;
  std::array<DexelAxis, 3> axes;
  std::size_t unresolved = 0;     ///< crossings left out because one grid edge held several
  std::vector<ThinSpot> thin;     ///< walls and gaps thinner than a cell
  std::size_t disagreements = 0;  ///< grid points settled by vote
  bool closed = false;            ///< the mesh has no boundary, so the directions agree without a vote
  bool cut_by_bounds = false;

  std::size_t size() const;  ///< crossings
};

}  // namespace evenmesh
