#pragma once
/// What a device can take over of mesh_shape().

#include "band/narrow_band_kernel.h"
#include "connect/label_complex.h"
#include "cvt/cells.h"
#include "evenmesh/mesh_shape.h"
#include "sample/ray_kernel.h"

namespace evenmesh {

/// None given: the CPU does it. The modules own the interfaces; what implements them is seen by nobody below the
/// caller.
struct Kernels {
  const RayKernel* rays = nullptr;
  const NarrowBandKernel* band = nullptr;
  const CellKernel* cells = nullptr;
  const ExtractionKernel* extraction = nullptr;
};

/// mesh_shape() with them. @param kept  see Artifacts
MeshResult mesh_with(const Kernels& kernels, const Shape& shape, const MeshOptions& options, ExecutionContext& context,
                     Artifacts& kept);

}  // namespace evenmesh
