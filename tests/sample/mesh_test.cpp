#include <gtest/gtest.h>

#include <numbers>

#include "core/random.h"
#include "evenmesh/error.h"
#include "geometry/primitives.h"
#include "grid/sample_checks.h"

namespace evenmesh {
namespace {

double area_of(const Mesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles)
    area += 0.5 * norm(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]));
  return area;
}

double volume_of(const Mesh& mesh) {
  double volume = 0;
  for (const Triangle& t : mesh.triangles)
    volume += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) / 6;
  return volume;
}

Mesh inverted(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  return mesh;
}

// Triangles with vertices of their own, as in STL files.
Mesh unwelded(const Mesh& mesh) {
  Mesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto n = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  return soup;
}

// A closed mesh of random vertices: all possible self-intersections.
Mesh tangled(std::uint64_t seed, double step) {
  Random random(seed);
  Mesh mesh = make_icosphere(1);
  for (Vec3& v : mesh.vertices)
    for (int a = 0; a < 3; ++a) v[a] = step > 0 ? step * double(random.below(17)) : random.uniform();
  return mesh;
}

Grid unit_grid(std::uint32_t n) {
  return {{0, 0, 0}, 1.0, {n, n, n}};
}

SampleSet on_grid(const Mesh& mesh, const Grid& grid) {
  return sample_shape(solid_of(mesh), grid);
}

TEST(SampleMesh, SmoothSolidsKeepAreaAndVolume) {
  for (const Mesh& mesh : {make_icosphere(4), make_torus(1, 0.35, 96, 48), make_box({1, 0.7, 0.5}, 3)}) {
    const SampleSet set = sampled(mesh, 100);
    expect_well_formed(set);
    const std::vector<bool> inside = expect_one_sign_grid(set);
    EXPECT_NEAR(set.total_area, area_of(mesh), 0.01 * area_of(mesh));
    EXPECT_NEAR(volume_of(set, inside), volume_of(mesh), 0.02 * volume_of(mesh));
    EXPECT_EQ(set.disagreements, 0u);
    EXPECT_FALSE(set.cut_by_bounds);
    for (const std::uint32_t source : set.source) EXPECT_LT(source, mesh.triangles.size());
  }
}

TEST(SampleMesh, SamplesLieOnTheirTriangles) {
  const Mesh mesh = make_torus(1, 0.35, 24, 12);
  const SampleSet set = sampled(mesh, 60);
  for (const SampleBlock& b : set.blocks)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      const Triangle& t = mesh.triangles[set.source[i]];
      const Vec3 a = mesh.vertices[t[0]];
      const Vec3 n = normalized(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
      EXPECT_LT(std::abs(dot(n, position(set, b, i) - a)), 1e-3 * set.grid.spacing);
      EXPECT_GT(dot(n, unpack_normal(set.normal[i])), 1 - 1e-6);
    }
}

TEST(SampleMesh, OrientationAndWeldingDoNotMatter) {
  const Mesh mesh = make_torus(1, 0.35, 20, 10);
  const SampleSet set = sampled(mesh, 50);
  SampleSet other = sampled(inverted(mesh), 50);
  EXPECT_TRUE(same_bytes(set.x, other.x) && same_bytes(set.edge, other.edge));
  expect_well_formed(other);
  other = sampled(unwelded(mesh), 50);
  EXPECT_EQ(other.disagreements, 0u);
  expect_same(set, other);
}

// Vertices, edges and faces exactly on grid points, lines and planes.
TEST(SampleMesh, AlignedCubeHoldsTheShiftedGridPoints) {
  const Mesh mesh = make_box_around({{4, 4, 4}, {12, 12, 12}}, 4);
  const SampleSet set = on_grid(mesh, unit_grid(17));
  expect_well_formed(set);
  // Points on the lower faces are shifted into the cube, those on the upper ones out of it.
  EXPECT_EQ(volume_of(set, expect_one_sign_grid(set)), 512.0);
  EXPECT_NEAR(set.total_area, 6 * 64, 1e-3);
}

TEST(SampleMesh, DiagonalEdgesThroughGridPoints) {
  Mesh octahedron;
  octahedron.vertices = {{4, 10, 10}, {16, 10, 10}, {10, 4, 10}, {10, 16, 10}, {10, 10, 4}, {10, 10, 16}};
  octahedron.triangles = {{1, 3, 5}, {3, 0, 5}, {0, 2, 5}, {2, 1, 5}, {3, 1, 4}, {0, 3, 4}, {2, 0, 4}, {1, 2, 4}};
  const SampleSet set = on_grid(octahedron, unit_grid(21));
  expect_well_formed(set);
  EXPECT_NEAR(volume_of(set, expect_one_sign_grid(set)), volume_of(octahedron), 20);
}

TEST(SampleMesh, ClosedTangledMeshesNeedNoVote) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const SampleSet set = sampled(tangled(seed, 0), 40);
    expect_well_formed(set);
    expect_one_sign_grid(set);
    EXPECT_EQ(set.disagreements, 0u);
  }
}

TEST(SampleMesh, ClosedTangledMeshesOnGridPointsNeedNoVote) {
  for (std::uint64_t seed = 1; seed <= 24; ++seed)
    for (const double step : {1.0, 0.5}) {
      const Mesh mesh = translated(tangled(seed, step), {3, 3, 3});
      const SampleSet set = on_grid(mesh, unit_grid(23));
      expect_well_formed(set);
      expect_one_sign_grid(set);
      EXPECT_EQ(set.disagreements, 0u);
    }
}

// Planes so steep that floating point says nothing about where a ray meets them, through grid points besides.
TEST(SampleMesh, NeedlesAlongTheGridNeedNoVote) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Random random(seed);
    Mesh mesh = make_icosphere(1);
    for (Vec3& v : mesh.vertices) {
      v.x = 3 + double(random.below(4000));
      for (int a = 1; a < 3; ++a) v[a] = 3 + double(random.below(3)) + 0x1p-16 * double(random.below(3));
    }
    const SampleSet set = on_grid(mesh, {{0, 0, 0}, 1.0, {4010, 10, 10}});
    expect_one_sign_grid(set);
    EXPECT_EQ(set.disagreements, 0u);
    for (Vec3& v : mesh.vertices) v = {v.y, v.z, v.x};
    expect_one_sign_grid(on_grid(mesh, {{0, 0, 0}, 1.0, {10, 10, 4010}}));
  }
}

// Seen along x, the triangle abc has the smallest area there is, and the grid point (5, 5) lies on its edge ab.
TEST(SampleMesh, TheSteepestPlanesNeedNoVote) {
  Random random(3);
  const double unit = 0x1p-16;
  for (int i = 0; i < 16; ++i) {
    Mesh mesh;
    const auto at = [&](double y, double z) { return Vec3{3 + double(random.below(4000)), 5 + y, 5 + z}; };
    const double side = i % 2 == 0 ? 1 : -1;
    mesh.vertices = {at(-65537 * unit, -65536 * unit), at(65537 * unit, 65536 * unit),
                     at(side * 65536 * unit, side * 65535 * unit), at(-2, 1.5)};
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    if (i % 4 < 2)
      for (Vec3& v : mesh.vertices) std::swap(v.y, v.z);
    const SampleSet set = on_grid(mesh, {{0, 0, 0}, 1.0, {4010, 10, 10}});
    expect_one_sign_grid(set);
    EXPECT_EQ(set.disagreements, 0u);
  }
}

TEST(SampleMesh, SliversAndTinyTrianglesNeedNoVote) {
  // Triangles far below the lattice, and far longer than wide.
  Mesh mesh = make_icosphere(5, 1.5);
  for (Vec3& v : mesh.vertices) v = {v.x, v.y * 0.05, v.z + 4 * v.x};
  const SampleSet set = sampled(mesh, 200);
  expect_one_sign_grid(set);
  EXPECT_EQ(set.disagreements, 0u);
}

TEST(SampleMesh, ThreadsDoNotMatter) {
  const Mesh mesh = merged(make_torus(), translated(make_icosphere(3), {0.5, 0.2, 0.1}));
  expect_same(sampled(mesh, 90, 1), sampled(mesh, 90, 2));
}

TEST(SampleMesh, OverlapsAreUnited) {
  const Mesh one = make_icosphere(4), both = merged(one, translated(one, {0.7, 0, 0}));
  const SampleSet set = sampled(both, 100);
  expect_one_sign_grid(set);
  // Area of two spherical caps joined along their common circle: 2 · 2πr(r + d/2).
  const double area = 4 * std::numbers::pi * 1.35;
  EXPECT_NEAR(set.total_area, area, 0.01 * area);
}

TEST(SampleMesh, ThinWallsAreCountedNotGuessed) {
  const SampleSet set = sampled(merged(make_box({1, 1, 0.002}), make_icosphere(2, 0.5)), 100);
  expect_well_formed(set);
  expect_one_sign_grid(set);
  EXPECT_GT(set.unresolved, 0u);
}

TEST(SampleMesh, BoundsCutAndClose) {
  Shape shape = solid_of(make_icosphere(4));
  shape.bounds = {{-2, -2, 0.1}, {0.3, 2, 2}};
  const SampleSet set = sample_shape(shape, make_grid(shape.bounds, 80));
  expect_well_formed(set);
  expect_one_sign_grid(set);
  EXPECT_TRUE(set.cut_by_bounds);
  for (const SampleBlock& b : set.blocks)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      const Vec3 p = position(set, b, i);
      EXPECT_TRUE(p.x < 0.3 + 1e-4 && p.z > 0.1 - 1e-4);
    }
}

TEST(SampleMesh, SaysWhatIsWrong) {
  Mesh mesh = make_box();
  EXPECT_THROW(sample_shape(solid_of(mesh), make_grid({{10, 10, 10}, {11, 11, 11}}, 8)), Error);
  mesh.triangles.push_back({0, 1, 99});
  Shape shape{"bad", {{-1, -1, -1}, {1, 1, 1}}, std::make_shared<const Mesh>(mesh), false};
  EXPECT_THROW(sample_shape(shape, make_grid(shape.bounds, 8)), InvalidInput);
  mesh.triangles.pop_back();
  mesh.vertices[0].x = std::nan("");
  shape.what = std::make_shared<const Mesh>(mesh);
  EXPECT_THROW(sample_shape(shape, make_grid(shape.bounds, 8)), InvalidInput);
}

}  // namespace
}  // namespace evenmesh
