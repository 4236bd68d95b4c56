#include "refine/vertex_constraints.h"

#include "refine/refine_testing.h"

namespace evenmesh {
namespace {

/// Every apex looks at all vertices.
std::size_t constrain_by_brute_force(Mesh& mesh, VertexConstraints& constraints, const std::vector<Vec3>& apexes,
                                     double max_distance) {
  std::size_t moved = 0;
  for (const Vec3& apex : apexes) {
    std::size_t nearest = 0;
    for (std::size_t v = 1; v < mesh.vertices.size(); ++v)
      if (squared_norm(mesh.vertices[v] - apex) < squared_norm(mesh.vertices[nearest] - apex)) nearest = v;
    if (constraints.curve[nearest] != VertexConstraints::free || norm(mesh.vertices[nearest] - apex) > max_distance)
      continue;
    constraints.curve[nearest] = VertexConstraints::corner;
    mesh.vertices[nearest] = apex;
    ++moved;
  }
  return moved;
}

TEST(ConstrainApexes, AgreeWithBruteForce) {
  std::size_t moved = 0, left = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    // On a coarse lattice distances tie, and apexes fall together.
    const double step = seed % 2 ? 0.25 : 0;
    const auto coordinate = [&](double scale) {
      const double x = scale * (random.uniform() - 0.5);
      return step > 0 ? step * std::round(x / step) : x;
    };
    const auto place = [&](double scale) {
      const double x = coordinate(scale), y = coordinate(scale), z = coordinate(scale);
      return Vec3{x, y, z};
    };
    Mesh mesh;
    for (int v = 0; v < 150; ++v) mesh.vertices.push_back(place(4));
    VertexConstraints constraints;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      constraints.curve.push_back(random.below(5) == 0 ? 0 : VertexConstraints::free);
    std::vector<Vec3> apexes;
    for (int a = 0; a < 40; ++a) apexes.push_back(place(6));
    const double max_distance = seed % 3 == 0 ? 0.25 : 0.7;
    Mesh expected = mesh;
    VertexConstraints expected_constraints = constraints;
    const std::size_t count = constrain_by_brute_force(expected, expected_constraints, apexes, max_distance);
    EXPECT_EQ(constrain_apexes(mesh, constraints, apexes, max_distance), count) << "seed " << seed;
    EXPECT_EQ(mesh.vertices, expected.vertices) << "seed " << seed;
    EXPECT_EQ(constraints.curve, expected_constraints.curve) << "seed " << seed;
    moved += count;
    left += apexes.size() - count;
  }
  EXPECT_GT(moved, 500u);
  EXPECT_GT(left, 500u);
}

TEST(ConstrainApexes, OfEmptyMeshesAndWithoutReachDoNothing) {
  Mesh none;
  VertexConstraints constraints;
  const std::vector<Vec3> apexes{{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(constrain_apexes(none, constraints, apexes, 1), 0u);
  Mesh sphere = make_icosphere(1);
  EXPECT_EQ(constrain_apexes(sphere, constraints, {}, 1), 0u);
  EXPECT_EQ(constrain_apexes(sphere, constraints, apexes, 0), 0u);
  EXPECT_EQ(sphere.vertices, make_icosphere(1).vertices);
  EXPECT_EQ(constrain_apexes(sphere, constraints, std::vector<Vec3>{{0, 0, 1.1}}, 1), 1u) << "all vertices are free";
  EXPECT_EQ(std::count(constraints.curve.begin(), constraints.curve.end(), VertexConstraints::corner), 1);
}

}  // namespace
}  // namespace evenmesh
