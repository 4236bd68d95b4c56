#include "band/voxelize.h"

#include <gtest/gtest.h>

#include "evenmesh/error.h"
#include "geometry/primitives.h"
#include "geometry/triangle.h"
#include "sample/sample.h"
#include "sample/test_fields.h"
#include "voxel_checks.h"

namespace evenmesh {
namespace {

enum class Kind { any, tiny, huge, on_grid, half_grid, axis_aligned, in_face, segment, along_axis, point, sliver };
constexpr Kind kinds[] = {Kind::any,        Kind::tiny,         Kind::huge,    Kind::on_grid,
                          Kind::half_grid,  Kind::axis_aligned, Kind::in_face, Kind::segment,
                          Kind::along_axis, Kind::point,        Kind::sliver};
constexpr std::int32_t unit = 1 << 16;  // of the lattice, per voxel

/// A triangle of the given kind around a grid of `side` voxels, on the lattice.
LatticeTriangle random_triangle(Kind kind, std::int32_t side, Random& random) {
  const auto below = [&](std::int64_t n) { return static_cast<std::int32_t>(random.below(std::uint64_t(n))); };
  LatticeTriangle t;
  for (LatticePoint& p : t)
    for (std::int32_t& x : p) {
      x = below(std::int64_t{side} * unit);
      if (kind == Kind::huge) x = below(8000 * unit) - 4000 * unit;
      if (kind == Kind::on_grid || kind == Kind::in_face) x = below(side + 1) * unit;
      if (kind == Kind::half_grid) x = below(2 * side + 1) * (unit / 2);
    }
  const auto axis = std::size_t(below(3)), other = (axis + 1) % 3;
  switch (kind) {
    case Kind::tiny:
      for (std::size_t a = 0; a < 3; ++a) {
        // Often across a face, an edge or a corner of voxels.
        const std::int32_t around = below(2) == 0 ? below(side) * unit : t[0][a];
        for (LatticePoint& p : t) p[a] = around + below(5) - 2;
      }
      break;
    case Kind::axis_aligned:
    case Kind::in_face:
      t[1][axis] = t[2][axis] = t[0][axis];
      break;
    case Kind::segment:
      for (std::size_t a = 0; a < 3; ++a) t[1][a] = t[0][a] & ~1, t[2][a] &= ~1, t[0][a] = (t[1][a] + t[2][a]) / 2;
      break;
    case Kind::along_axis:
      t[1] = t[2] = t[0];
      t[1][axis] = below(side) * unit, t[2][axis] = below(side * unit);
      if (below(2) == 0)
        for (LatticePoint& p : t) p[other] = t[0][other] & -unit;
      break;
    case Kind::point:
      if (below(2) == 0) t[0][axis] &= -unit;
      t[1] = t[2] = t[0];
      break;
    case Kind::sliver:
      for (std::size_t a = 0; a < 3; ++a) t[1][a] = (t[0][a] + t[2][a]) / 2 + below(3) - 1;
      break;
    default:
      break;
  }
  return t;
}

Vec3 as_vec(const LatticePoint& p) {
  return Vec3{double(p[0]), double(p[1]), double(p[2])} * (1.0 / unit);
}

void append(Mesh& mesh, const LatticeTriangle& t) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const LatticePoint& p : t) mesh.vertices.push_back(as_vec(p));
  mesh.triangles.push_back({n, n + 1, n + 2});
}

TEST(VoxelizeMesh, MarksExactlyWhatATriangleTouches) {
  const VoxelGrid grid = unit_voxels(19, 18, 17);
  Random random(1);
  for (const Kind kind : kinds)
    for (int n = 0; n < 24; ++n) {
      const LatticeTriangle triangle = random_triangle(kind, 17, random);
      Mesh mesh;
      append(mesh, triangle);
      const SiteVoxels sites = voxelize_mesh(mesh, grid);
      std::size_t missed = 0, too_many = 0;
      for_all_voxels(grid, [&](const Voxel& v) {
        const bool marked = sites.tiles.contains(v), touched = touches(triangle, v, 16);
        if (touched && !marked) ++missed;
        if (marked && !touched) ++too_many;
      });
      EXPECT_EQ(missed, 0u) << "kind " << int(kind) << ", triangle " << n;
      EXPECT_EQ(too_many, 0u) << "kind " << int(kind) << ", triangle " << n;
    }
}

// Far larger than the grid: the lattice becomes coarser, the walk stays within the grid.
TEST(VoxelizeMesh, CutsWhatLeavesTheGrid) {
  Mesh mesh;
  mesh.vertices = {{-4e6, -4e6, 3.5}, {4e6, -4e6, 3.5}, {0, 8e6, 3.5}};
  mesh.triangles = {{0, 1, 2}};
  const VoxelGrid grid = unit_voxels(9, 9, 9);
  const SiteVoxels sites = voxelize_mesh(mesh, grid);
  expect_well_formed(sites);
  EXPECT_EQ(sites.size(), 81u);
  EXPECT_EQ(sites.outside, 1u);
  for (const Voxel& v : voxels_of(sites.tiles)) EXPECT_EQ(v[2], 3);
  for (Vec3& p : mesh.vertices) p.z = -100;
  EXPECT_EQ(voxelize_mesh(mesh, grid).size(), 0u);
}

TEST(VoxelizeMesh, ATriangleInAFaceMarksBothSides) {
  Mesh mesh;
  mesh.vertices = {{2, 4, 2}, {6, 4, 2}, {2, 4, 6}};
  mesh.triangles = {{0, 1, 2}};
  const SiteVoxels sites = voxelize_mesh(mesh, unit_voxels(10, 10, 10));
  for (const Voxel& v : voxels_of(sites.tiles)) EXPECT_TRUE(v[1] == 3 || v[1] == 4);
  EXPECT_TRUE(sites.tiles.contains({3, 3, 3}) && sites.tiles.contains({3, 4, 3}));
  // Its corner touches eight voxels.
  EXPECT_TRUE(sites.tiles.contains({1, 3, 1}) && sites.tiles.contains({6, 4, 1}));
}

TEST(VoxelizeMesh, SurfacePointsAreTheNearestOnes) {
  const VoxelGrid grid = unit_voxels(18, 17, 19);
  Random random(2);
  for (int round = 0; round < 4; ++round) {
    Mesh mesh;
    std::vector<LatticeTriangle> triangles;
    for (const Kind kind : kinds)
      for (int n = 0; n < 3; ++n) triangles.push_back(random_triangle(kind, 17, random));
    for (int copy = 0; copy < 2; ++copy)  // each twice: the first of both is to win
      for (const LatticeTriangle& t : triangles) append(mesh, t);
    const SiteVoxels sites = voxelize_mesh(mesh, grid);
    expect_well_formed(sites);
    const std::vector<Voxel> voxels = voxels_of(sites.tiles);
    std::size_t off = 0;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      const Vec3 center = grid.center(voxels[i]), point = surface_point(sites, voxels[i], i);
      double nearest = 1e9;
      for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (!touches(triangles[t], voxels[i], 16)) continue;
        const auto [a, b, c] = corners_of(mesh, t);
        nearest = std::min(nearest, norm(closest_point_on_triangle(center, a, b, c) - center));
      }
      ASSERT_LT(sites.source[i], triangles.size());
      const auto [a, b, c] = corners_of(mesh, sites.source[i]);
      // On its triangle, no farther than any other, and near the voxel. On slivers closest_point_on_triangle() loses
      // some digits.
      if (norm(closest_point_on_triangle(point, a, b, c) - point) > 1e-3) ++off;
      if (std::abs(norm(point - center) - nearest) > 1e-3) ++off;
      if (norm(point - center) > 0.8661) ++off;
      const Vec3 normal = normalized(area_normal(a, b, c));
      if (norm(normal) > 0 && dot(normal, unpack_normal(sites.normal[i])) < 0.9999) ++off;
    }
    EXPECT_EQ(off, 0u);
  }
}

TEST(VoxelizeMesh, ThreadsDoNotMatter) {
  const Mesh mesh = merged(make_torus(), translated(make_icosphere(3), {0.5, 0.2, 0.1}));
  const VoxelGrid grid = make_voxel_grid(mesh.bounds(), 90, 4);
  evenmesh::ExecutionContext one(1), two(2);
  const SiteVoxels sites = voxelize_mesh(mesh, grid, one);
  expect_same(sites, voxelize_mesh(mesh, grid, two));
  expect_well_formed(sites);
  EXPECT_EQ(sites.outside, 0u);
}

TEST(VoxelizeMesh, ScaleAndPlaceDoNotMatter) {
  const Mesh mesh = make_torus();
  const VoxelGrid grid = make_voxel_grid(mesh.bounds(), 64, 4);
  const SiteVoxels sites = voxelize_mesh(mesh, grid);
  Mesh small = mesh;
  for (Vec3& p : small.vertices) p *= 0x1p-60;
  VoxelGrid small_grid = grid;
  small_grid.origin *= 0x1p-60, small_grid.side *= 0x1p-60;
  const SiteVoxels scaled = voxelize_mesh(small, small_grid);
  EXPECT_TRUE(same_tiles(sites.tiles, scaled.tiles));
  EXPECT_TRUE(same_bytes(sites.source, scaled.source) && same_bytes(sites.normal, scaled.normal));
}

TEST(VoxelizeMesh, SaysWhatIsWrong) {
  Mesh mesh = make_box();
  const VoxelGrid grid = make_voxel_grid(mesh.bounds(), 8, 2);
  mesh.triangles.push_back({0, 1, 99});
  EXPECT_THROW(voxelize_mesh(mesh, grid), InvalidInput);
  mesh.triangles.pop_back();
  mesh.vertices[0].x = std::nan("");
  EXPECT_THROW(voxelize_mesh(mesh, grid), InvalidInput);
  mesh.vertices[0].x = 1e12;
  EXPECT_THROW(voxelize_mesh(mesh, grid), InvalidInput);
  EXPECT_EQ(voxelize_mesh(Mesh{}, grid).size(), 0u);
}

TEST(VoxelizePoints, AVoxelHasTheMeanOfItsPoints) {
  const std::vector<Vec3> points{{1.25, 1.5, 1.5}, {8.5, 8.5, 8.5}, {1.75, 1.5, 1.0},
                                 {-1, 0, 0},       {2, 3, 4},       {20, 1, 1}};
  const std::vector<Vec3> normals{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, -1, 0}, {1, 0, 0}};
  const SiteVoxels sites = voxelize_points(points, normals, unit_voxels(20, 20, 20));
  expect_well_formed(sites);
  EXPECT_EQ(voxels_of(sites.tiles), (std::vector<Voxel>{{1, 1, 1}, {2, 3, 4}, {8, 8, 8}}));
  EXPECT_EQ(sites.outside, 2u);
  EXPECT_LT(norm(surface_point(sites, {1, 1, 1}, 0) - Vec3{1.5, 1.5, 1.25}), 1e-6);
  EXPECT_LT(norm(surface_point(sites, {2, 3, 4}, 1) - Vec3{2, 3, 4}), 1e-6);
  EXPECT_LT(norm(unpack_normal(sites.normal[0]) - normalized({1, 1, 0})), 1e-4);
  EXPECT_TRUE(voxelize_points(points, {}, unit_voxels(20, 20, 20)).normal.empty());
  EXPECT_THROW(voxelize_points(points, std::span(normals).first(2), unit_voxels(20, 20, 20)), InvalidInput);
  const std::vector<Vec3> bad{{0, 0, std::nan("")}};
  EXPECT_THROW(voxelize_points(bad, {}, unit_voxels(20, 20, 20)), InvalidInput);
}

TEST(VoxelizePoints, ThreadsDoNotMatter) {
  Random random(3);
  std::vector<Vec3> points(200000);
  for (Vec3& p : points) p = {random.uniform(), random.uniform(), random.uniform()};
  const VoxelGrid grid = make_voxel_grid({{0, 0, 0}, {1, 1, 1}}, 40, 1);
  evenmesh::ExecutionContext one(1), two(2);
  const SiteVoxels sites = voxelize_points(points, points, grid, one);
  expect_same(sites, voxelize_points(points, points, grid, two));
  expect_well_formed(sites);
  std::set<Voxel> held;
  for (const Vec3& p : points) {
    const Vec3 q = (p - grid.origin) * (1 / grid.side);
    held.insert({std::int32_t(q.x), std::int32_t(q.y), std::int32_t(q.z)});
  }
  EXPECT_EQ(held.size(), sites.size());
  for (const Voxel& v : held) EXPECT_TRUE(sites.tiles.contains(v));
}

/// A voxel is a site exactly when the field has not one sign on its corners.
template <typename Inside>
void expect_crossed_voxels(const SiteVoxels& sites, const Inside& inside) {
  std::size_t wrong = 0;
  for_all_voxels(sites.grid, [&](const Voxel& v) {
    int corners = 0;
    for (int c = 0; c < 8; ++c) corners += inside(v[0] + (c & 1), v[1] + (c >> 1 & 1), v[2] + (c >> 2));
    if (sites.tiles.contains(v) != (corners > 0 && corners < 8)) ++wrong;
  });
  EXPECT_EQ(wrong, 0u);
}

TEST(VoxelizeField, MarksTheVoxelsThatTheSurfaceCrosses) {
  const BallField ball;
  const VoxelGrid grid = make_voxel_grid({{-1, -1, -1}, {1, 1, 1}}, 40, 4);
  evenmesh::ExecutionContext one(1), two(2);
  const SiteVoxels sites = voxelize_field(ball, grid, {}, one);
  expect_same(sites, voxelize_field(ball, grid, {}, two));
  expect_well_formed(sites);
  expect_crossed_voxels(sites, [&](int i, int j, int k) {
    return squared_norm(grid.origin + grid.side * Vec3{double(i), double(j), double(k)}) < 1;
  });
  const std::vector<Voxel> voxels = voxels_of(sites.tiles);
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const Vec3 point = surface_point(sites, voxels[i], i);
    EXPECT_NEAR(norm(point), 1, 0.5 * grid.side * grid.side);
    EXPECT_GT(dot(normalized(point), unpack_normal(sites.normal[i])), 0.999);
    for (int a = 0; a < 3; ++a) EXPECT_LE(std::abs((point - grid.center(voxels[i]))[a]), 0.501 * grid.side);
  }
}

TEST(VoxelizeSamples, CellsOfTheSamplesGridThatTheSurfaceCrosses) {
  const SampleSet samples = sampled(make_torus(), 60);
  const std::vector<bool> inside = expect_one_sign_grid(samples);
  const auto& n = samples.grid.size;
  for (const unsigned margin : {0u, 3u, 8u}) {
    const SiteVoxels sites = voxelize_samples(samples, margin);
    expect_well_formed(sites);
    const auto m = static_cast<int>(margin);
    expect_crossed_voxels(sites, [&](int i, int j, int k) {
      i -= m, j -= m, k -= m;
      const auto within = [&](int at, std::size_t a) { return at >= 0 && at < int(n[a]); };
      if (!within(i, 0) || !within(j, 1) || !within(k, 2)) return false;
      return bool(inside[(std::size_t(k) * n[1] + std::size_t(j)) * n[0] + std::size_t(i)]);
    });
    EXPECT_LT(norm(sites.grid.center({m, m, m}) - samples.grid.point(0.5, 0.5, 0.5)), 1e-9);
  }
  EXPECT_THROW(voxelize_samples(samples, 65), InvalidInput);
}

TEST(VoxelGrid, HoldsTheBoundsAndTheMargin) {
  const Box box{{-1, 2, 3}, {7, 2.5, 3}};
  const VoxelGrid grid = make_voxel_grid(box, 16, 4);
  EXPECT_EQ(grid.size, (std::array<std::uint32_t, 3>{25, 10, 9}));
  EXPECT_LT(norm(grid.center({4, 4, 4}) - box.lo), 1e-12);
  EXPECT_LT(norm(grid.center({20, 5, 4}) - box.hi), 1e-12);
  EXPECT_GT(make_voxel_grid({{0, 0, 0}, {1, 1, 1}}, 8192, 21).voxels(), std::uint64_t{1} << 39);
  EXPECT_THROW(make_voxel_grid({}, 16, 4), InvalidInput);
  EXPECT_THROW(make_voxel_grid(box, 0, 4), InvalidInput);
  EXPECT_THROW(make_voxel_grid(box, 8193, 4), InvalidInput);
  EXPECT_THROW(make_voxel_grid(box, 16, 0), InvalidInput);
}

}  // namespace
}  // namespace evenmesh
