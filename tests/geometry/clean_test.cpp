#include <gtest/gtest.h>

#include "evenmesh/repair.h"
#include "geometry/half_edges.h"
#include "geometry/primitives.h"

namespace evenmesh {
namespace {

/// Every triangle with vertices of its own, every third turned, some repeated, some degenerate.
Mesh soup_of(const Mesh& mesh) {
  Mesh soup;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), {a, b, c});
    soup.triangles.push_back({first, first + 1, first + 2});
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 &a = mesh.vertices[mesh.triangles[t][0]], &b = mesh.vertices[mesh.triangles[t][1]],
               &c = mesh.vertices[mesh.triangles[t][2]];
    t % 3 == 0 ? add(a, c, b) : add(a, b, c);
    if (t % 7 == 0) add(b, c, a);
    if (t % 11 == 0) add(a, a, b), add(a, b, 0.5 * (a + b));
  }
  return soup;
}

TEST(Cleaned, ASoupOfTurnedTrianglesIsAMeshAgain) {
  for (const Mesh& mesh : {make_icosphere(2), make_torus()}) {
    MeshDefects defects;
    const Mesh result = cleaned(soup_of(mesh), defects);
    EXPECT_EQ(result.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(result.vertices.size(), mesh.vertices.size());
    const HalfEdges edges(result.triangles, result.vertices.size());
    for (std::size_t h = 0; h < 3 * result.triangles.size(); ++h) ASSERT_NE(edges.opposite(h), HalfEdges::none);
    EXPECT_EQ(defects.boundary_edges, 0u);
    EXPECT_EQ(defects.non_manifold_edges, 0u);
    EXPECT_EQ(defects.patches, 1u);
    EXPECT_GT(defects.turned_triangles, mesh.triangles.size() / 5);
    EXPECT_GT(defects.repeated_triangles, 0u);
    EXPECT_GT(defects.degenerate_triangles, 0u);
    double volume = 0;
    for (const Triangle& t : result.triangles)
      volume += dot(result.vertices[t[0]], cross(result.vertices[t[1]], result.vertices[t[2]]));
    EXPECT_GT(volume, 0) << "most triangles faced outward";
  }
}

TEST(Cleaned, LeavesGoodMeshesAlone) {
  MeshDefects defects;
  const Mesh mesh = make_icosphere(2), result = cleaned(mesh, defects);
  EXPECT_EQ(result.triangles, mesh.triangles);
  EXPECT_EQ(result.vertices, mesh.vertices);
  EXPECT_EQ(defects.turned_triangles + defects.welded_vertices, 0u);
}

}  // namespace
}  // namespace evenmesh
