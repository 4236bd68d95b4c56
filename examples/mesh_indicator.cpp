/// Meshes a solid of which only "inside or outside?" is known: a ball with a hole drilled through it.

#include <evenmesh/io.h>
#include <evenmesh/mesh_shape.h>

#include <cstdio>

int main() {
  using evenmesh::Vec3;
  const auto inside = [](const Vec3& p) { return squared_norm(p) < 1 && p.x * p.x + p.y * p.y > 0.1; };
  evenmesh::Box bounds;
  bounds.add({-1.1, -1.1, -1.1});
  bounds.add({1.1, 1.1, 1.1});
  const auto [mesh, report] =
      evenmesh::mesh_shape(evenmesh::shape_from_indicator(inside, bounds, "bead"), {.edge_length = 0.05});
  std::printf("%zu vertices, Euler number %lld (0: the hole goes through)\n", report.quality.vertices,
              static_cast<long long>(report.quality.euler));
  evenmesh::write_mesh(mesh, "bead.ply");
}
