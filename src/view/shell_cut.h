#pragma once
/// A cut through a shell and the mesh in it.

#include "evenmesh/render.h"

namespace evenmesh {

/// One layer of voxels, the nearer to the surface the darker, and where the layer's middle plane cuts the mesh.
///
/// @param cut     voxels that share one coordinate, at least one
/// @param width   of the picture in pixels, [64, 8192]; its height follows
/// @param window  side of the square that is shown, in voxels, around the voxel in the middle of the list; 0:
/// everything
Image shell_cut_image(const SparseVolume& cut, const Mesh& mesh, int width, double window = 0);

}  // namespace evenmesh
