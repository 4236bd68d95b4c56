#include "refine/flips.h"

#include "refine/refine_testing.h"

namespace evenmesh {
namespace {

double angle_at(const Vec3& apex, const Vec3& a, const Vec3& b) {
  return std::atan2(norm(cross(a - apex, b - apex)), dot(a - apex, b - apex));
}

/// Largest sum of the two angles opposite to an edge.
double largest_opposite_angles(const Mesh& mesh) {
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  const auto corner = [&](std::uint32_t h) { return mesh.vertices[mesh.triangles[h / 3][h % 3]]; };
  double largest = 0;
  for (std::uint32_t h = 0; h < 3 * mesh.triangles.size(); ++h) {
    const std::uint32_t o = edges.opposite(h);
    const Vec3 a = corner(h), b = corner(o);
    largest = std::max(largest,
                       angle_at(corner(HalfEdges::previous(h)), a, b) + angle_at(corner(HalfEdges::previous(o)), a, b));
  }
  return largest;
}

TEST(Flips, MakeAShakenSphereDelaunay) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Mesh mesh = perturbed_sphere(3, 0.02, seed);
    const auto vertices = mesh.vertices;
    ASSERT_GT(largest_opposite_angles(mesh), std::numbers::pi + 0.01);
    const std::size_t triangles = mesh.triangles.size();
    EXPECT_GT(flip_to_delaunay(mesh), 0u);
    expect_closed_manifold(mesh);
    EXPECT_EQ(mesh.vertices, vertices);
    EXPECT_EQ(mesh.triangles.size(), triangles);
    EXPECT_LE(largest_opposite_angles(mesh), std::numbers::pi + 1e-6);
    EXPECT_GT(volume_of(mesh), 4.0);
    EXPECT_EQ(flip_to_delaunay(mesh), 0u) << "nothing is left to do";
  }
}

TEST(Flips, KeepTheManifoldWhateverTheShape) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Mesh mesh = seed % 2 ? make_torus(1, 0.35, 24, 12) : make_icosphere(2);
    Random random(seed);
    for (Vec3& v : mesh.vertices) {
      const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
      v += 0.02 * static_cast<double>(seed) * Vec3{x, y, z};  // up to a crumpled ball
    }
    const std::int64_t euler =
        static_cast<std::int64_t>(mesh.vertices.size() + mesh.triangles.size() - edge_count(mesh));
    flip_to_delaunay(mesh);
    expect_closed_manifold(mesh);
    EXPECT_EQ(static_cast<std::int64_t>(mesh.vertices.size() + mesh.triangles.size() - edge_count(mesh)), euler);
    for (const Triangle& t : mesh.triangles) EXPECT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
  }
}

TEST(Flips, DoNotRoundOffSharpEdges) {
  for (Mesh mesh : {make_tetrahedron(), make_box({1, 1, 1}), make_box({1, 0.2, 0.05}, 4)}) {
    const double volume = volume_of(mesh);
    flip_to_delaunay(mesh);
    expect_closed_manifold(mesh);
    EXPECT_NEAR(volume_of(mesh), volume, 1e-12);
  }
}

TEST(Flips, SurviveTrianglesWithoutArea) {
  Mesh mesh = make_icosphere(2);
  for (int v = 0; v < 20; ++v) mesh.vertices[static_cast<std::size_t>(v)] = mesh.vertices[100];
  flip_to_delaunay(mesh);
  expect_closed_manifold(mesh);
}

TEST(Flips, ATriangleWithoutAreaIsFlippedAway) {
  // A square pyramid with a vertex in the middle of one edge of its base, where a flat triangle hangs.
  Mesh mesh{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 1}, {1, 0, 0}},
            {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {5, 0, 2}, {5, 2, 1}, {0, 3, 2}}};
  EXPECT_GT(flip_to_delaunay(mesh), 0u);
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    EXPECT_GT(norm(cross(b - a, c - a)), 0.1);
  }
}

}  // namespace
}  // namespace evenmesh
