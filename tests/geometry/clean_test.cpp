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

TEST(Cleaned, WallsBetweenBodiesAreNoRepetitions) {
  const Mesh a = make_box_around({{0, 0, 0}, {1, 1, 1}});
  MeshDefects defects;
  const Mesh both = cleaned(merged(a, translated(a, {1, 0, 0})), defects);
  EXPECT_EQ(both.triangles.size(), 20u);
  EXPECT_EQ(both.vertices.size(), 12u);
  EXPECT_EQ(defects.repeated_triangles, 0u);
  EXPECT_EQ(defects.wall_triangles % 4, 0u);
  EXPECT_EQ(defects.boundary_edges, 0u);
  EXPECT_EQ(defects.non_manifold_edges, 0u);
}

TEST(Cleaned, OfTwoSidesOfASheetOneStays) {
  Mesh sheet = make_grid_plane(3, 3);
  const std::size_t given = sheet.triangles.size();
  for (std::size_t t = 0; t < given; ++t)
    sheet.triangles.push_back({sheet.triangles[t][0], sheet.triangles[t][2], sheet.triangles[t][1]});
  MeshDefects defects;
  EXPECT_EQ(cleaned(sheet, defects).triangles.size(), given);
  EXPECT_EQ(defects.repeated_triangles, given);
  EXPECT_EQ(defects.wall_triangles, 0u);
}

TEST(Cleaned, TrianglesWithoutAreaThatJoinOthersStay) {
  // The edge of one triangle ends in the middle of another's: a flat one lies between.
  Mesh mesh = make_box_around({{0, 0, 0}, {1, 1, 1}});
  const Triangle cut = mesh.triangles.back();
  mesh.triangles.pop_back();
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(0.5 * (mesh.vertices[cut[0]] + mesh.vertices[cut[1]]));
  mesh.triangles.insert(mesh.triangles.end(),
                        {{cut[0], middle, cut[2]}, {middle, cut[1], cut[2]}, {cut[1], middle, cut[0]}});
  mesh.triangles.back() = {cut[0], cut[1], middle};
  MeshDefects defects;
  cleaned(mesh, defects);
  EXPECT_EQ(defects.degenerate_triangles, 0u);
  EXPECT_EQ(defects.boundary_edges, 0u);
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
