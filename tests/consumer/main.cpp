/// A user of the installed library: meshes a sphere and checks what came out.

#include <evenmesh/mesh_shape.h>

#include <cstdio>

int main() {
  const evenmesh::MeshResult result = evenmesh::mesh_shape(evenmesh::gallery_shape("sphere"), {.vertices = 500});
  const evenmesh::MeshQuality& quality = result.report.quality;
  std::printf("%zu vertices, %zu faces, Euler number %lld\n", quality.vertices, quality.faces,
              static_cast<long long>(quality.euler));
  return quality.closed() && quality.two_manifold() && quality.euler == 2 ? 0 : 1;
}
