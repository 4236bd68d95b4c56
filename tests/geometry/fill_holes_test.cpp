#include <gtest/gtest.h>

#include "evenmesh/repair.h"
#include "geometry/half_edges.h"
#include "geometry/primitives.h"

namespace evenmesh {
namespace {

/// Without the triangles whose middle is in the way.
template <typename Gone>
Mesh without(Mesh mesh, const Gone& gone) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return gone((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  });
  return mesh;
}

TEST(HolesFilled, ABallWithHolesIsWholeAgain) {
  const Mesh ball = make_icosphere(4);
  const Mesh holed = without(ball, [](const Vec3& p) {
    return p.z > 0.9 || p.x < -0.85 || norm(p - Vec3{0.7, 0.7, 0}) < 0.2 || norm(p - Vec3{0, 0, -1}) < 0.05;
  });
  std::size_t filled = 0;
  const Mesh whole = holes_filled(holed, filled);
  EXPECT_EQ(filled, 4u);
  const HalfEdges edges(whole.triangles, whole.vertices.size());
  std::size_t used = 0;
  double volume = 0;
  for (std::size_t h = 0; h < 3 * whole.triangles.size(); ++h) ASSERT_NE(edges.opposite(h), HalfEdges::none);
  for (std::uint32_t v = 0; v < whole.vertices.size(); ++v) {
    EXPECT_LE(edges.umbrellas(v), 1u);
    used += edges.umbrellas(v);
  }
  EXPECT_EQ(2 * used, whole.triangles.size() + 4) << "the topology of a ball";
  for (const Triangle& t : whole.triangles)
    volume += dot(whole.vertices[t[0]], cross(whole.vertices[t[1]], whole.vertices[t[2]])) / 6;
  EXPECT_NEAR(volume, 4.1, 0.1);
  EXPECT_EQ(whole.vertices, holed.vertices);
  EXPECT_TRUE(std::equal(holed.triangles.begin(), holed.triangles.end(), whole.triangles.begin()));
}

TEST(HolesFilled, WholeMeshesStayAsTheyAre) {
  std::size_t filled = 1;
  EXPECT_EQ(holes_filled(make_torus(), filled).triangles, make_torus().triangles);
  EXPECT_EQ(filled, 0u);
}

TEST(HolesFilled, RimsThatFaceEachOtherStayOpen) {
  const Mesh torn = without(make_icosphere(4), [](const Vec3& p) { return std::abs(p.z) < 0.06; });
  std::size_t filled = 0;
  EXPECT_EQ(holes_filled(torn, filled).triangles, torn.triangles);
  EXPECT_EQ(filled, 0u);
}

TEST(HolesFilled, AFinIsNoHole) {
  Mesh mesh = make_icosphere(2);
  const Triangle t = mesh.triangles.front();
  mesh.vertices.push_back(1.5 * mesh.vertices[t[0]]);
  mesh.triangles.push_back({t[0], t[1], static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
  std::size_t filled = 0;
  EXPECT_EQ(holes_filled(mesh, filled).triangles.size(), mesh.triangles.size());
  EXPECT_EQ(filled, 0u);
}

TEST(HolesFilled, SoupsAreLeftAsTheyAre) {
  Mesh soup;
  for (std::uint32_t i = 0; i < 12'000; ++i) {
    const double x = i;
    soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    soup.vertices.insert(soup.vertices.end(), {{x, 0, 0}, {x + 0.5, 0, 0}, {x, 0.5, 0.1}});
  }
  std::size_t filled = 1;
  EXPECT_EQ(holes_filled(soup, filled).triangles, soup.triangles);
  EXPECT_EQ(filled, 0u);
}

}  // namespace
}  // namespace evenmesh
