/// Meshes a mesh file anew: example_remesh_file IN OUT VERTICES. Shows progress, and stops at two minutes.

#include <evenmesh/io.h>
#include <evenmesh/measure.h>
#include <evenmesh/mesh_shape.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: example_remesh_file IN OUT VERTICES\n");
    return 2;
  }
  const auto start = std::chrono::steady_clock::now();
  evenmesh::ExecutionContext context;  // how: all processors; nothing in it changes the mesh
  context.on_progress([&](std::string_view stage, double fraction) {
    std::fprintf(stderr, "\r%3.0f %%  %-20.*s", 100 * fraction, static_cast<int>(stage.size()), stage.data());
    if (std::chrono::steady_clock::now() - start > std::chrono::minutes(2)) context.cancel();
  });
  try {
    const evenmesh::Mesh input = evenmesh::read_mesh(argv[1], context);
    const std::size_t vertices = std::strtoull(argv[3], nullptr, 10);
    const auto result =
        evenmesh::mesh_shape(evenmesh::shape_from_mesh(input, argv[1]), {.vertices = vertices}, context);
    for (const evenmesh::Finding& finding : result.report.findings)
      std::fprintf(stderr, "\n%s", finding.sentence.c_str());
    const evenmesh::MeshDistance distance = evenmesh::compare_meshes(result.mesh, input, {}, context);
    std::printf("\nHausdorff distance to the input: %.3g of the diagonal\n",
                distance.hausdorff() / distance.reference_diagonal);
    evenmesh::write_mesh(result.mesh, argv[2]);
  } catch (const evenmesh::Error& error) {
    std::fprintf(stderr, "\nerror: %s\n", error.what());
    return 1;
  }
  return 0;
}
