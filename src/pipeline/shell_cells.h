#pragma once
/// The shell method between samples and triangles: seeds and their dual, open where the input is.

#include "pipeline/cells_to_mesh.h"
#include "pipeline/shell_sampling.h"

namespace evenmesh {

/// Balances `report.seeds_asked` seeds and connects their cells; seeds are added where the topology needs them.
///
/// The result is a two-manifold with boundary: where that takes a cut, vertices are split in `separate_umbrellas`.
/// Based on [NBEDT §3.3, 3.4]: balancing happens on the surface in the middle of the shell, each border voxel carried
/// to its nearest site, and cells are connected along the shell's border.
ConnectedCells connect_shell(const ShellSampling& sampling, const MeshOptions& options, StageTimer& timer,
                             Report& report, ExecutionContext& context);

/// Gives every fan of triangles around a vertex a vertex of its own; edges of three triangles and more come apart.
/// Returns the number of new vertices; `source` gets the vertex that each one was copied from.
std::size_t separate_umbrellas(Mesh& mesh, std::vector<std::uint32_t>& source);

}  // namespace evenmesh
