#include "evenmesh/points.h"

namespace evenmesh {

Box PointCloud::bounds() const {
  Box box;
  for (const Vec3& p : points) box.add(p);
  return box;
}

}  // namespace evenmesh
