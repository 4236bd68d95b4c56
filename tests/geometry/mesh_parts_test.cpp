#include "geometry/mesh_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "core/random.h"
#include "geometry/primitives.h"
#include "geometry/shared_edges.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

MeshParts parts(const Mesh& mesh, bool turn = true) {
  ExecutionContext context(2);
  return parts_of(
      mesh, turn, [](const Mesh&) { return 0.0; }, context);
}

Mesh box(const Vec3& lo, const Vec3& hi, int cuts = 1) {
  return make_box_around({lo, hi}, cuts);
}

Mesh inside_out(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

Mesh two_sided(const Mesh& mesh) {
  Mesh both = mesh;
  for (const Triangle& t : mesh.triangles) both.triangles.push_back({t[0], t[2], t[1]});
  return both;
}

Mesh shuffled(Mesh mesh) {
  Random random(5);
  for (Triangle& t : mesh.triangles)
    if (random.below(2) == 0) std::swap(t[1], t[2]);
  return mesh;
}

Mesh rectangle(const Vec3& a, const Vec3& u, const Vec3& v) {
  return {{a, a + u, a + u + v, a + v}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Without the triangles whose middle is in the way.
template <typename Gone>
Mesh without(Mesh mesh, const Gone& gone) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return gone((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  });
  return mesh;
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    sum += dot(a, cross(b, c)) / 6;
  }
  return sum;
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    sum += triangle_area(a, b, c);
  }
  return sum;
}

void expect_closed(const Mesh& mesh) {
  for_each_edge(edge_uses(mesh.triangles), [](std::span<const EdgeUse> edge) {
    int sum = 0;
    for (const EdgeUse& use : edge) sum += use.up ? 1 : -1;
    EXPECT_EQ(sum, 0);
  });
}

TEST(MeshParts, WhatIsInOrderStaysAsItIs) {
  const Mesh ball = make_icosphere(2);
  EXPECT_TRUE(parts(ball).as_given);
  EXPECT_TRUE(parts(inside_out(ball)).as_given);
  EXPECT_TRUE(parts(merged(ball, translated(ball, {0.5, 0, 0}))).as_given);
  EXPECT_TRUE(parts(merged(ball, inside_out(make_icosphere(2, 0.5)))).as_given) << "a cavity";
  EXPECT_TRUE(parts(merged(inside_out(ball), make_icosphere(2, 0.5))).as_given) << "a cavity, all inside out";
  EXPECT_TRUE(parts(merged(ball, merged(inside_out(make_icosphere(2, 0.6)), make_icosphere(2, 0.3)))).as_given);
}

TEST(MeshParts, HolesOfSolidsAreFilled) {
  const Mesh cube = box({0, 0, 0}, {1, 1, 1}), fine = box({0, 0, 0}, {1, 1, 1}, 6), ball = make_icosphere(3);
  for (const Mesh& whole : {cube, inside_out(cube), fine, ball})
    for (const std::size_t lost : {1u, 2u}) {
      Mesh mesh = whole;
      for (std::size_t i = 0; i < lost; ++i) mesh.triangles.erase(mesh.triangles.begin() + static_cast<long>(3 * i));
      const MeshParts found = parts(mesh);
      EXPECT_EQ(found.filled_holes.size(), lost);
      EXPECT_TRUE(found.sheet_pieces.empty());
      expect_closed(found.solid);
      EXPECT_NEAR(volume(found.solid), volume(whole), 1e-9);
      EXPECT_GT(found.filled_holes[0].size, 0);
      EXPECT_GE(found.filled_holes.front().size, found.filled_holes.back().size);
    }
  const MeshParts large = parts(without(ball, [](const Vec3& p) { return p.z > 0.85; }));
  EXPECT_EQ(large.filled_holes.size(), 1u);
  expect_closed(large.solid);
}

TEST(MeshParts, HolesThatTouchAreFilled) {
  Mesh mesh = make_icosphere(3);
  const std::uint32_t v = mesh.triangles[0][0];
  std::vector<std::size_t> around;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (std::count(mesh.triangles[t].begin(), mesh.triangles[t].end(), v) > 0) around.push_back(t);
  // Two triangles at a vertex that are no neighbours.
  const auto other = std::find_if(around.begin() + 1, around.end(), [&](std::size_t t) {
    return std::count_if(mesh.triangles[t].begin(), mesh.triangles[t].end(), [&](std::uint32_t w) {
             const Triangle& first = mesh.triangles[around[0]];
             return std::find(first.begin(), first.end(), w) != first.end();
           }) == 1;
  });
  ASSERT_NE(other, around.end());
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<long>(*other));
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<long>(around[0]));
  const MeshParts found = parts(mesh);
  EXPECT_EQ(found.filled_holes.size(), 2u);
  expect_closed(found.solid);
}

TEST(MeshParts, MouthsStayOpen) {
  const auto lid = [](const Vec3& p) { return p.z > 0.999; };
  const auto lids = [](const Vec3& p) { return std::abs(p.z) > 0.999; };
  const Mesh bowl = without(make_icosphere(3), [](const Vec3& p) { return p.z > 0; });
  const Mesh cup = without(make_box({1, 1, 1}, 4), lid), glass = without(make_box({0.1, 0.1, 1}, 8), lid);
  const Mesh pipe = without(make_box({0.1, 0.1, 1}, 8), lids);
  for (const Mesh& mesh : {bowl, cup, glass, pipe, make_grid_plane(3, 3)}) {
    const MeshParts found = parts(mesh);
    EXPECT_TRUE(found.solid.triangles.empty());
    EXPECT_TRUE(found.filled_holes.empty());
    EXPECT_EQ(found.sheet_pieces.size(), 1u);
    EXPECT_NEAR(area(found.sheets), area(mesh), 1e-9);
  }
}

TEST(MeshParts, TurnedTrianglesAreTurnedBack) {
  const MeshParts found = parts(shuffled(make_icosphere(3)));
  expect_closed(found.solid);
  EXPECT_GT(found.turned_triangles, 100u);
  EXPECT_NEAR(std::abs(volume(found.solid)), volume(make_icosphere(3)), 1e-9);
}

TEST(MeshParts, InvertedBodiesAreTurned) {
  const Mesh a = box({0, 0, 0}, {1, 1, 1}), b = inside_out(box({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));
  const MeshParts found = parts(merged(a, b));
  ASSERT_EQ(found.turned_bodies.size(), 1u);
  EXPECT_NEAR(norm(found.turned_bodies[0].middle - Vec3{1, 1, 1}), 0, 1e-9);
  EXPECT_NEAR(volume(found.solid), 2, 1e-9);
  EXPECT_TRUE(parts(merged(a, b), false).as_given);
  // A body and its cavity turn together; a pocket that ends in the surface is a cavity, too.
  const Mesh hollow = merged(make_icosphere(2), inside_out(make_icosphere(2, 0.5)));
  const MeshParts shells = parts(merged(translated(hollow, {1, 0, 0}), inside_out(hollow)));
  EXPECT_EQ(shells.turned_bodies.size(), 2u);
  EXPECT_NEAR(volume(shells.solid), 2 * volume(hollow), 1e-9);
  EXPECT_TRUE(parts(merged(a, inside_out(box({0.2, 0.2, 0.5}, {0.8, 0.8, 1})))).turned_bodies.empty());
}

TEST(MeshParts, WallsBetweenTouchingBodiesGo) {
  const Mesh a = box({0, 0, 0}, {1, 1, 1}), b = box({1, 0, 0}, {2, 1, 1}), c = box({1, 1, 0}, {2, 2, 1});
  for (const Mesh& mesh : {merged(a, merged(b, c)), merged(a, merged(inside_out(b), c))}) {
    const MeshParts found = parts(mesh);
    if (found.as_given) continue;
    EXPECT_TRUE(found.sheet_pieces.empty());
    expect_closed(found.solid);
    EXPECT_NEAR(std::abs(volume(found.solid)), 3, 1e-9);
    EXPECT_NEAR(area(found.solid), 14, 1e-9);
  }
}

TEST(MeshParts, SheetsBesideASolidAreToldApart) {
  const Mesh block = box({0, 0, 0}, {1, 1, 0.4}), fin = rectangle({0.5, 0, 0.2}, {0, 1, 0}, {0, 0, 1.3});
  for (const Mesh& sheet : {fin, two_sided(fin)}) {
    const MeshParts found = parts(merged(block, sheet));
    EXPECT_NEAR(volume(found.solid), 0.4, 1e-9);
    EXPECT_NEAR(area(found.solid), area(block), 1e-9);
    ASSERT_EQ(found.sheet_pieces.size(), 1u);
    EXPECT_NEAR(found.sheet_pieces[0].area, 1.3, 1e-9);
    EXPECT_NEAR(norm(found.sheet_pieces[0].middle - Vec3{0.5, 0.5, 0.85}), 0, 1e-9);
  }
  const MeshParts hidden = parts(merged(block, rectangle({0.5, 0.2, 0.1}, {0, 0.6, 0}, {0, 0, 0.2})));
  EXPECT_TRUE(hidden.sheet_pieces.empty());
  EXPECT_NEAR(area(hidden.solid), area(block), 1e-9);
}

TEST(MeshParts, SheetsAttachedToASolidAreTakenOff) {
  Mesh block = box({0, 0, 0}, {1, 1, 0.4});
  const auto vertex = [&](const Vec3& p) {
    return static_cast<std::uint32_t>(std::find(block.vertices.begin(), block.vertices.end(), p) -
                                      block.vertices.begin());
  };
  const std::uint32_t a = vertex({0, 0, 0.4}), b = vertex({0, 1, 0.4});
  block.vertices.insert(block.vertices.end(), {{0, 0, 1}, {0, 1, 1}});
  block.triangles.insert(block.triangles.end(), {{a, b, 9}, {a, 9, 8}});
  const MeshParts found = parts(block);
  expect_closed(found.solid);
  EXPECT_EQ(found.solid.triangles.size(), 12u);
  EXPECT_EQ(found.sheet_pieces.size(), 1u);
}

TEST(MeshParts, PartitionsAreTakenOut) {
  Mesh mesh = box({0, 0, 0}, {1, 1, 1}, 2);
  const std::size_t given = mesh.triangles.size();
  const auto vertex = [&](const Vec3& p) {
    return static_cast<std::uint32_t>(std::find(mesh.vertices.begin(), mesh.vertices.end(), p) - mesh.vertices.begin());
  };
  const Vec3 ring[] = {{0.5, 0, 0}, {0.5, 0.5, 0}, {0.5, 1, 0}, {0.5, 1, 0.5},
                       {0.5, 1, 1}, {0.5, 0.5, 1}, {0.5, 0, 1}, {0.5, 0, 0.5}};
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0.5, 0.5, 0.5});
  for (std::size_t i = 0; i < 8; ++i) mesh.triangles.push_back({middle, vertex(ring[i]), vertex(ring[(i + 1) % 8])});
  const MeshParts found = parts(mesh);
  EXPECT_EQ(found.solid.triangles.size(), given);
  expect_closed(found.solid);
  EXPECT_TRUE(found.sheet_pieces.empty());
}

TEST(MeshParts, BothSidesOfAClosedSurfaceAreABody) {
  const Mesh ball = make_icosphere(2);
  for (const Mesh& mesh : {two_sided(ball), merged(ball, ball), merged(ball, inside_out(ball))}) {
    const MeshParts found = parts(mesh);
    if (found.as_given) continue;  // a body twice is one by its winding number
    EXPECT_EQ(found.solid.triangles.size(), ball.triangles.size());
    EXPECT_TRUE(found.sheet_pieces.empty());
  }
}

}  // namespace
}  // namespace evenmesh
