#pragma once
/// The shell method between shape and samples: voxels, shell, sheets.

#include "band/sheets.h"
#include "evenmesh/mesh_shape.h"
#include "pipeline/stage_timer.h"

namespace evenmesh {

/// The surface as the shell method samples it.
struct ShellSampling {
  BandSurface surface;  ///< both sides of the shell
  Sheets sheets;
  SampleSet samples;                      ///< the chosen side, in the order of `surface`
  std::vector<std::uint32_t> in_surface;  ///< index of each of `samples` in surface.samples
  SampleSet on_surface;                   ///< the same, drawn onto the surface in the middle of the shell
};

/// Chooses resolution and thickness, samples, keeps the shell if asked for, and fills in the report's counts: asked
/// seeds, samples, sites, shell.
/// @throws UnusableInput  nothing of the surface lies within the bounds
ShellSampling sample_by_shell(const Shape& shape, const MeshOptions& options, StageTimer& timer, Report& report,
                              Artifacts& kept, ExecutionContext& context);

/// The same for the solid that wraps the surface: what the outside cannot reach, eroded back by the thickness to one
/// voxel above the surface (a morphological closing). Closed, whatever the input is; its samples bound a solid.
SampleSet sample_wrapping(const Shape& shape, const MeshOptions& options, StageTimer& timer, Report& report,
                          Artifacts& kept, ExecutionContext& context);

}  // namespace evenmesh
