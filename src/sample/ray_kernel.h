#pragma once
/// The sampling of solids, as a device can take it over.

#include "sample/sample.h"

namespace evenmesh {

class RayKernel {
 public:
  virtual ~RayKernel() = default;
  /// @return crossings with the guarantees of sample_shape(), which it calls for what it cannot do itself
  virtual SampleSet sample(const Shape& shape, const Grid& grid, ExecutionContext& context) const = 0;
};

}  // namespace evenmesh
