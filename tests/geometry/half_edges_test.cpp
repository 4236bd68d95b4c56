#include "geometry/half_edges.h"

#include <gtest/gtest.h>

#include "geometry/primitives.h"

namespace evenmesh {
namespace {

std::uint32_t start(const std::vector<Triangle>& triangles, std::uint32_t h) {
  return triangles[h / 3][h % 3];
}

TEST(HalfEdges, OppositesRunBackAlongTheSameEdge) {
  for (const Mesh& mesh : {make_icosphere(2), make_torus(), make_box(), make_tetrahedron()}) {
    const HalfEdges edges(mesh.triangles, mesh.vertices.size());
    for (std::uint32_t h = 0; h < 3 * mesh.triangles.size(); ++h) {
      const std::uint32_t o = edges.opposite(h);
      ASSERT_NE(o, HalfEdges::none);
      EXPECT_EQ(edges.opposite(o), h);
      EXPECT_EQ(start(mesh.triangles, o), start(mesh.triangles, HalfEdges::next(h)));
      EXPECT_EQ(start(mesh.triangles, HalfEdges::next(o)), start(mesh.triangles, h));
    }
  }
}

TEST(HalfEdges, NextAndPreviousGoAroundTheTriangle) {
  for (std::uint32_t h = 0; h < 12; ++h) {
    EXPECT_EQ(HalfEdges::next(h) / 3, h / 3);
    EXPECT_EQ(HalfEdges::previous(HalfEdges::next(h)), h);
    EXPECT_EQ(HalfEdges::next(HalfEdges::next(HalfEdges::next(h))), h);
  }
}

TEST(HalfEdges, VerticesKnowTheirCorners) {
  const Mesh mesh = make_icosphere(1);
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  std::size_t corners = 0, of_five = 0;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    corners += edges.corners(v), of_five += edges.corners(v) == 5;
    EXPECT_EQ(start(mesh.triangles, edges.outgoing(v)), v);
    EXPECT_EQ(edges.fans(v), 1u);
  }
  EXPECT_EQ(corners, 3 * mesh.triangles.size());
  EXPECT_EQ(of_five, 12u);
}

TEST(HalfEdges, UnusedVerticesHaveNothing) {
  const std::vector<Triangle> triangles{{0, 1, 3}};
  const HalfEdges edges(triangles, 5);
  EXPECT_EQ(edges.outgoing(2), HalfEdges::none);
  EXPECT_EQ(edges.corners(4), 0u);
  EXPECT_EQ(edges.fans(4), 0u);
  const HalfEdges nothing({}, 0);
}

TEST(HalfEdges, BoundariesHaveNoOpposite) {
  const Mesh mesh = make_grid_plane(4, 3);
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  std::size_t open = 0;
  for (std::uint32_t h = 0; h < 3 * mesh.triangles.size(); ++h) open += edges.opposite(h) == HalfEdges::none;
  EXPECT_EQ(open, 14u);
}

TEST(HalfEdges, EdgesOfThreeTrianglesOrAgainstEachOtherHaveNoOpposite) {
  const std::vector<Triangle> fan{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, against{{0, 1, 2}, {0, 1, 3}};
  for (const auto& triangles : {fan, against}) {
    const HalfEdges edges(triangles, 5);
    for (std::uint32_t h = 0; h < 3 * triangles.size(); h += 3) EXPECT_EQ(edges.opposite(h), HalfEdges::none);
  }
}

TEST(HalfEdges, BodiesThatShareAVertexAreTwoFans) {
  Mesh mesh = merged(make_tetrahedron(), make_tetrahedron());
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t)
      if (v == 4) v = 0;
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  EXPECT_EQ(edges.fans(0), 2u);
  EXPECT_EQ(edges.fans(1), 1u);
  EXPECT_EQ(edges.corners(0), 6u);
}

}  // namespace
}  // namespace evenmesh
