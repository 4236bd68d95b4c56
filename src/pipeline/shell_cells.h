#pragma once
/// The shell method between shape and cells: voxels, shell, sheets; then seeds and their dual, open where the input is.

#include "connect/sheets.h"
#include "pipeline/cells_to_mesh.h"

namespace evenmesh {

/// The surface as the shell method samples it.
struct ShellSampling {
  ShellSurface surface;  ///< both sides of the shell
  Sheets sheets;
  SampleSet samples;     ///< the chosen side, in the order of `surface`
  SampleSet on_surface;  ///< the same, drawn onto the surface in the middle of the shell
};

/// Whether a triangle mesh is far from bounding a solid: its boundary is more than 1 % of its edges, or its area
/// vectors do not cancel out.
bool is_open_surface(const Mesh& mesh);

/// Chooses resolution and thickness, samples, and fills in the report's counts: asked seeds, samples, sites, shell.
/// @throws UnusableInput  nothing of the surface lies within the bounds
ShellSampling sample_by_shell(const Shape& shape, const MeshOptions& options, Stages& stages, Report& report, Run& run);

/// The same for the solid that wraps the surface: what the outside cannot reach, eroded back by the thickness to one
/// voxel above the surface (a morphological closing). Closed, whatever the input is; its samples bound a solid.
SampleSet sample_wrapping(const Shape& shape, const MeshOptions& options, Stages& stages, Report& report, Run& run);

/// Balances `report.seeds_asked` seeds and connects their cells; seeds are added where the topology needs them.
///
/// The result is a two-manifold with boundary: where that takes a cut, vertices are split in `separate_fans`.
/// Based on [NBEDT §3.3, 3.4]: balancing happens on the surface in the middle of the shell, each border voxel carried
/// to its nearest site, and cells are connected along the shell's border.
ConnectedCells connect_shell(const ShellSampling& sampling, const MeshOptions& options, Stages& stages, Report& report,
                             Run& run);

/// Gives every fan of triangles around a vertex a vertex of its own; edges of three triangles and more come apart.
/// Returns the number of new vertices; `source` gets the vertex that each one was copied from.
std::size_t separate_fans(Mesh& mesh, std::vector<std::uint32_t>& source);

}  // namespace evenmesh
