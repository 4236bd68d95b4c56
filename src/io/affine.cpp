#include "io/affine.h"

#include <utility>

namespace evenmesh {

void append_placed(const Source& source, const Mesh& part, const PartPlacement& placement, Mesh& mesh) {
  const std::size_t base = mesh.vertices.size();
  if (base + part.vertices.size() > max_vertices) fail(source, "has more than 4,294,967,295 vertices; split it");
  for (const Vec3& v : part.vertices) mesh.vertices.push_back(placement(v));
  const bool mirrors = placement.mirrors();
  for (Triangle t : part.triangles) {
    for (std::uint32_t& v : t) v += static_cast<std::uint32_t>(base);
    if (mirrors) std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }
}

}  // namespace evenmesh
