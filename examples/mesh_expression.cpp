/// Meshes an implicit surface, prints its figures, writes it.

#include <evenmesh/io.h>
#include <evenmesh/mesh_shape.h>

#include <cstdio>

int main() {
  const evenmesh::Shape shape =
      evenmesh::shape_from_expression("(x^2+y^2+z^2+R^2-r^2)^2 = 4R^2(x^2+y^2)", {{"R", 1.0}, {"r", 0.4}});
  const auto [mesh, report] = evenmesh::mesh_shape(shape, {.vertices = 5000});
  std::printf("%zu vertices, mean Q %.3f, Euler number %lld\n", report.quality.vertices, report.quality.q_avg,
              static_cast<long long>(report.quality.euler));
  evenmesh::write_mesh(mesh, "torus.ply");
}
