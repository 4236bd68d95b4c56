#pragma once
/// The distance transform, as a device can take it over.

#include "band/narrow_band.h"

namespace evenmesh {

class NarrowBandKernel {
 public:
  virtual ~NarrowBandKernel() = default;
  /// @return what build_narrow_band() gives, to the last bit
  virtual NarrowBand build(const SiteVoxels& sites, unsigned reach, ExecutionContext& context) const = 0;
};

}  // namespace evenmesh
