#include "refine/give_way.h"

#include <numeric>

#include "refine/refine_testing.h"

namespace evenmesh {
namespace {

std::vector<std::uint32_t> all_vertices(const Mesh& mesh) {
  std::vector<std::uint32_t> list(mesh.vertices.size());
  std::iota(list.begin(), list.end(), 0u);
  return list;
}

TEST(GiveWay, MakesTrianglesGoodAndStaysOnTheSurface) {
  evenmesh::ExecutionContext context(1);
  const Shape shape = gallery_shape("sphere");
  const auto projector = make_projector(shape, shape.bounds, context);
  Mesh mesh = perturbed_sphere(4, 0.01, 3);
  for (Vec3& v : mesh.vertices) v = projector->project(v, 1);
  const VertexRings rings(mesh);
  const double before = worst_score(mesh);
  give_way(mesh, rings, projector.get(), all_vertices(mesh), 20);
  EXPECT_LT(before, 0.9);
  EXPECT_GT(worst_score(mesh), std::max(0.95, before));
  for (const Vec3& v : mesh.vertices) EXPECT_LT(norm(projector->project(v, 0.1) - v), 1e-9);
}

TEST(GiveWay, LeavesGoodTrianglesAndThoseNotListedAlone) {
  Mesh mesh = make_icosphere(3);
  const std::vector<Vec3> vertices = mesh.vertices;
  const VertexRings rings(mesh);
  give_way(mesh, rings, nullptr, all_vertices(mesh), 10);
  EXPECT_EQ(mesh.vertices, vertices) << "good enough";

  const std::uint32_t pushed = 100;
  mesh.vertices[pushed] += 0.4 * (mesh.vertices[rings.neighbours(pushed)[0]] - mesh.vertices[pushed]);
  Mesh untouched = mesh;
  give_way(mesh, rings, nullptr, rings.neighbours(pushed), 10);
  EXPECT_GT(worst_score(mesh), worst_score(untouched));
  const auto beside = rings.neighbours(pushed);
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const bool listed = std::find(beside.begin(), beside.end(), v) != beside.end();
    EXPECT_TRUE(listed || mesh.vertices[v] == untouched.vertices[v]);
  }
}

}  // namespace
}  // namespace evenmesh
