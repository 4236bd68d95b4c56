#include "geometry/half_edges.h"

#include <gtest/gtest.h>

#include <algorithm>

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
    EXPECT_EQ(edges.umbrellas(v), 1u);
  }
  EXPECT_EQ(corners, 3 * mesh.triangles.size());
  EXPECT_EQ(of_five, 12u);
}

TEST(HalfEdges, UnusedVerticesHaveNothing) {
  const std::vector<Triangle> triangles{{0, 1, 3}};
  const HalfEdges edges(triangles, 5);
  EXPECT_EQ(edges.outgoing(2), HalfEdges::none);
  EXPECT_EQ(edges.corners(4), 0u);
  EXPECT_EQ(edges.umbrellas(4), 0u);
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
  const std::vector<Triangle> umbrella{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, against{{0, 1, 2}, {0, 1, 3}};
  for (const auto& triangles : {umbrella, against}) {
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
  EXPECT_EQ(edges.umbrellas(0), 2u);
  EXPECT_EQ(edges.umbrellas(1), 1u);
  EXPECT_EQ(edges.corners(0), 6u);
}

/// The triangles around a vertex as visit_umbrellas() lists them: third corners, fan by fan.
std::vector<std::vector<std::uint32_t>> fans_at(const std::vector<Triangle>& triangles, std::size_t vertices,
                                                std::uint32_t v) {
  const HalfEdges edges(triangles, vertices);
  std::vector<std::vector<std::uint32_t>> list;
  edges.visit_umbrellas(v, [&](std::uint32_t h, std::uint32_t umbrella) {
    EXPECT_EQ(start(triangles, h), v);
    EXPECT_LE(umbrella, list.size());
    list.resize(std::max<std::size_t>(list.size(), umbrella + 1));
    if (!list[umbrella].empty()) {  // one triangle after the other, each across an edge of the last
      const std::uint32_t last = list[umbrella].back();
      EXPECT_EQ(edges.opposite(HalfEdges::previous(last)), h);
    }
    list[umbrella].push_back(h);
  });
  EXPECT_EQ(edges.umbrellas(v), list.size());
  return list;
}

TEST(HalfEdges, AClosedFanIsVisitedOnceAround) {
  const Mesh mesh = make_icosphere(1);
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto umbrellas = fans_at(mesh.triangles, mesh.vertices.size(), v);
    ASSERT_EQ(umbrellas.size(), 1u);
    EXPECT_EQ(umbrellas[0].size(), edges.corners(v));
    EXPECT_EQ(edges.opposite(HalfEdges::previous(umbrellas[0].back())), umbrellas[0].front());
  }
}

TEST(HalfEdges, AnOpenFanIsOneWhereverItIsStored) {
  std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  std::sort(triangles.begin(), triangles.end());
  do {
    const HalfEdges edges(triangles, 6);
    const auto umbrellas = fans_at(triangles, 6, 0);
    ASSERT_EQ(umbrellas.size(), 1u);
    ASSERT_EQ(umbrellas[0].size(), 4u);
    EXPECT_EQ(edges.opposite(umbrellas[0].front()), HalfEdges::none) << "it begins on the boundary";
    EXPECT_EQ(edges.opposite(HalfEdges::previous(umbrellas[0].back())), HalfEdges::none) << "and ends there";
  } while (std::next_permutation(triangles.begin(), triangles.end()));
}

TEST(HalfEdges, EveryVertexOfADiscIsOneFan) {
  const Mesh plane = make_grid_plane(3, 3);
  std::size_t corners = 0;
  for (std::uint32_t v = 0; v < plane.vertices.size(); ++v) {
    const auto umbrellas = fans_at(plane.triangles, plane.vertices.size(), v);
    ASSERT_EQ(umbrellas.size(), 1u);
    corners += umbrellas[0].size();
  }
  EXPECT_EQ(corners, 3 * plane.triangles.size());
}

TEST(HalfEdges, ABowtieIsTwoFans) {
  const std::vector<Triangle> bowtie{{0, 1, 2}, {4, 0, 3}, {2, 3, 0}, {5, 6, 0}};
  const auto umbrellas = fans_at(bowtie, 7, 0);
  ASSERT_EQ(umbrellas.size(), 2u);
  EXPECT_EQ(umbrellas[0].size() + umbrellas[1].size(), 4u);
  EXPECT_EQ(std::min(umbrellas[0].size(), umbrellas[1].size()), 1u);
  EXPECT_EQ(fans_at(bowtie, 7, 2).size(), 1u);
}

TEST(HalfEdges, AClosedAndAnOpenFanMayMeet) {
  Mesh mesh = make_tetrahedron();
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.triangles.push_back({0, n, n + 1});
  const auto umbrellas = fans_at(mesh.triangles, n + 2, 0);
  ASSERT_EQ(umbrellas.size(), 2u);
  EXPECT_EQ(umbrellas[0].size(), 3u);
  EXPECT_EQ(umbrellas[1].size(), 1u);
}

TEST(HalfEdges, TrianglesAtAnEdgeOfThreeAreFansOfTheirOwn) {
  const std::vector<Triangle> fin{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  EXPECT_EQ(fans_at(fin, 5, 0).size(), 3u);
  EXPECT_EQ(fans_at(fin, 5, 2).size(), 1u);
}

}  // namespace
}  // namespace evenmesh
