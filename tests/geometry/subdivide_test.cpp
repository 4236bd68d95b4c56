#include "geometry/subdivide.h"

#include <gtest/gtest.h>

#include "geometry/half_edges.h"
#include "geometry/primitives.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

std::size_t irregular_vertices(const Mesh& mesh) {
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  std::size_t count = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    EXPECT_EQ(edges.umbrellas(v), 1u);
    count += edges.corners(v) != 6;
  }
  return count;
}

std::size_t boundary_edges(const Mesh& mesh) {
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  std::size_t count = 0;
  for (std::size_t h = 0; h < 3 * mesh.triangles.size(); ++h) count += edges.opposite(h) == HalfEdges::none;
  return count;
}

TEST(Subdivide, KeepsSurfaceAndIrregularVertices) {
  const Mesh mesh = make_icosphere(2), halved = subdivide(mesh).mesh;
  EXPECT_EQ(halved.triangles.size(), 4 * mesh.triangles.size());
  EXPECT_EQ(2 * halved.vertices.size(), halved.triangles.size() + 4) << "still a sphere";
  EXPECT_EQ(boundary_edges(halved), 0u);
  EXPECT_EQ(irregular_vertices(halved), irregular_vertices(mesh));
  EXPECT_NEAR(area_of(halved), area_of(mesh), 1e-12 * area_of(mesh));
}

TEST(Subdivide, NewVerticesAreInTheMiddleOfTheirEdges) {
  const Mesh mesh = make_icosphere(1);
  const SubdividedMesh halved = subdivide(mesh);
  ASSERT_EQ(halved.mesh.vertices.size(), mesh.vertices.size() + halved.edges.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) EXPECT_EQ(halved.mesh.vertices[v], mesh.vertices[v]);
  for (std::size_t e = 0; e < halved.edges.size(); ++e) {
    const auto [a, b] = halved.edges[e];
    EXPECT_LT(a, b);
    EXPECT_EQ(halved.mesh.vertices[mesh.vertices.size() + e], 0.5 * (mesh.vertices[a] + mesh.vertices[b]));
  }
}

TEST(Subdivide, GoesAlongABoundary) {
  const Mesh triangle{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
  const SubdividedMesh halved = subdivide(triangle);
  EXPECT_EQ(halved.mesh.vertices.size(), 6u);
  EXPECT_EQ(boundary_edges(halved.mesh), 6u);
  EXPECT_TRUE(subdivide({}).mesh.triangles.empty());
}

}  // namespace
}  // namespace evenmesh
