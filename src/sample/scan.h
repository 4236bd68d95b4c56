#pragma once
/// Triangle meshes as runs along the rays of three directions, and these as samples.

#include <array>
#include <span>

#include "core/parallel.h"
#include "evenmesh/mesh.h"
#include "evenmesh/shape.h"
#include "grid/tri_dexel.h"

namespace evenmesh {

/// Scan conversion of a triangle mesh; a point is inside where the winding number is not zero, or above zero.
///
/// Guarantee: for a mesh without boundary, self-intersecting or not, of either orientation, the three directions imply
/// the same inside at every grid point: vertices are snapped to a lattice of 2^-16 cells, everything after is exact,
/// and ties are broken by one symbolic shift of the grid points (Edelsbrunner, Mücke, Simulation of simplicity, ToG
/// 1990). For other meshes rays that do not come back to winding number 0 are read by parity or lose their unmatched
/// crossing, and the directions are reconciled by the vote of their majority.
/// Cost: O(triangles + crossings); a vote adds O(grid points / 64).
/// @param bounds  empty: the mesh must fit into the grid; otherwise the solid is cut by this box and closed on its
/// faces
/// @throws InvalidInput  an index is out of range, a coordinate not finite, or the mesh does not fit into the grid
TriDexel scan_mesh(const Mesh& mesh, const Grid& grid, ExecutionContext& context = ExecutionContext::silent(),
                   const Box& bounds = {}, Winding winding = Winding::any);

/// The same, without a vote: each direction says what it sees.
TriDexel scan_rays(const Mesh& mesh, const Grid& grid, ExecutionContext& context, Winding winding = Winding::any);

class ExtraDirections;

/// Replaces the three directions' opinions, where they differ, by the majority of theirs and the witnesses', if there
/// are, point by point, and rebuilds the crossings from that one sign grid. `raw[a]` holds every crossing of axis a as
/// it was found, for the positions of new crossings.
/// @param rounding  cells; points in dispute next to which, so near, a ray has a crossing do not count as
/// disagreements,
///                  and such crossings are moved
/// Cost: O(grid points / 64 + crossings), and 0.3 µs for every point in dispute.
void vote(TriDexel& solid, const std::array<DexelAxis, 3>& raw, const ExtraDirections* extra_directions,
          const ExecutionContext& context, double rounding = 0);

/// The crossings of a solid in blocks, with the normals of the mesh it was scanned from.
SampleSet sample_dexels(const TriDexel& solid, const Mesh& mesh, const ExecutionContext& context);

/// Where a crossing has no normal: one is fitted to the samples around it.
inline constexpr PackedNormal no_normal{0xffffffffu};

/// The same with the normals that DexelCrossing::source counts; of either orientation. The samples have no sources.
SampleSet sample_dexels(const TriDexel& solid, std::span<const PackedNormal> normals, const ExecutionContext& context);

}  // namespace evenmesh
