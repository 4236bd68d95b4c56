#include "evenmesh/mesh.h"

namespace evenmesh {

Box Mesh::bounds() const {
  Box box;
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) box.add(vertices[v]);
  return box;
}

}  // namespace evenmesh
