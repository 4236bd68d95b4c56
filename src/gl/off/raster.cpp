#include "evenmesh/raster.h"

#include "gl/off/refuse.h"

namespace evenmesh {

Shape shape_from_raster(const RasterOptions&, std::string) {
  gl::refuse();
}

}  // namespace evenmesh
