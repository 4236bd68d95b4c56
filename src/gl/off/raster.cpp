#include "evenmesh/raster.h"

#include "evenmesh/error.h"

namespace evenmesh {

Shape shape_from_raster(const RasterOptions&, std::string) {
  throw NotAvailable("this build has no OpenGL: configure with -DEVENMESH_GL=ON");
}

}  // namespace evenmesh
