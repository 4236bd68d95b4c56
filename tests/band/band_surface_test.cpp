#include "band/band_surface.h"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "band/band_checks.h"
#include "band/moving_least_squares.h"
#include "evenmesh/error.h"
#include "evenmesh/points.h"
#include "geometry/primitives.h"
#include "grid/blocks.h"

namespace evenmesh {
namespace {

constexpr double pi = std::numbers::pi;

TEST(BandSurface, BoundsASolid) {
  const Mesh meshes[] = {make_icosphere(3), make_torus(), make_grid_plane(3, 2), make_box({0.5, 0.3, 0.01})};
  for (const Mesh& mesh : meshes)
    for (const unsigned reach : {1u, 2u, 4u}) {
      const BandOf made = band_of(mesh, 24, reach);
      const SampleSet& set = made.surface.samples;
      ASSERT_EQ(made.surface.site.size(), set.size());
      ASSERT_EQ(made.surface.facing.size(), set.size());
      const std::vector<bool> inside = expect_one_sign_grid(set);
      EXPECT_EQ(static_cast<std::uint64_t>(std::count(inside.begin(), inside.end(), true)), made.band.size());
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < set.size(); ++i)
        wrong += made.surface.site[i] >= made.sites.size() || !(std::abs(made.surface.facing[i]) <= 1.001f) ||
                 !std::isfinite(set.x[i] + set.y[i] + set.z[i]);
      EXPECT_EQ(wrong, 0u);
    }
}

TEST(BandSurface, IsTwoSpheresAroundASphere) {
  for (const unsigned reach : {2u, 4u}) {
    const BandOf made = band_of(make_icosphere(5), 48, reach);
    const double h = made.sites.grid.side, d = (reach + 0.5) * h;
    expect_well_formed(made.surface.samples);
    EXPECT_NEAR(made.surface.samples.total_area, 4 * pi * ((1 + d) * (1 + d) + (1 - d) * (1 - d)), 0.03 * 8 * pi);
    std::size_t wrong_side = 0, far = 0, unclear = 0;
    for_samples(made.surface.samples, [&](std::size_t i, const Vec3& p) {
      const float facing = made.surface.facing[i];
      unclear += std::abs(facing) < clearly_facing;
      wrong_side += (facing > 0) != (norm(p) > 1);
      wrong_side += (facing > 0) != (dot(unpack_normal(made.surface.samples.normal[i]), p) > 0);
      far += std::abs(std::abs(norm(p) - 1) - d) > h;
    });
    EXPECT_EQ(wrong_side, 0u);
    EXPECT_EQ(far, 0u);
    EXPECT_LT(unclear, made.surface.samples.size() / 100);
  }
}

TEST(BandSurface, DrawnOntoASphereLiesOnIt) {
  const BandOf made = band_of(make_icosphere(5), 48, 2);
  // Those in front only: a subset, as for a sheet.
  std::vector<std::uint32_t> index;
  for (std::uint32_t i = 0; i < made.surface.facing.size(); ++i)
    if (made.surface.facing[i] > 0) index.push_back(i);
  const SampleSet front = gather(made.surface.samples, index);
  evenmesh::ExecutionContext context(2);
  const SampleSet drawn = drawn_onto_surface(front, index, made.surface, made.sites, context);
  ASSERT_EQ(drawn.size(), front.size());
  double worst = 0;
  for_samples(drawn, [&](std::size_t, const Vec3& p) { worst = std::max(worst, std::abs(norm(p) - 1)); });
  EXPECT_LT(worst, made.sites.grid.side) << "within a voxel";
}

TEST(BandSurface, SameBytesForAnyNumberOfThreads) {
  const BandOf one = band_of(make_torus(), 40, 2, 1), three = band_of(make_torus(), 40, 2, 3);
  expect_same(one.surface.samples, three.surface.samples);
  EXPECT_TRUE(same_bytes(one.surface.site, three.surface.site));
  EXPECT_TRUE(same_bytes(one.surface.facing, three.surface.facing));
}

TEST(BandSurface, OfNothingIsRefused) {
  evenmesh::ExecutionContext context(1);
  const VoxelGrid grid = make_voxel_grid({{0, 0, 0}, {1, 1, 1}}, 16, 3);
  const SiteVoxels none = voxelize_mesh(translated(make_icosphere(1), {50, 0, 0}), grid, context);
  ASSERT_EQ(none.size(), 0u);
  EXPECT_THROW(band_surface(build_narrow_band(none, 2, context), none, context), UnusableInput);
}

TEST(EstimateNormals, AreThoseOfTheSurfaceEitherWayRound) {
  evenmesh::ExecutionContext context(2);
  const PointCloud cloud = ball_of_points(8000);
  const VoxelGrid grid = make_voxel_grid(cloud.bounds(), 40, 6);
  SiteVoxels sites = voxelize_points(cloud.points, {}, grid, context);
  estimate_normals(sites, 4, context);
  ASSERT_EQ(sites.normal.size(), sites.size());
  double worst = 1;
  for_sites(sites, [&](std::size_t i, const Vec3& p) {
    worst = std::min(worst, std::abs(dot(unpack_normal(sites.normal[i]), normalized(p))));
  });
  EXPECT_GT(worst, 0.9);
}

TEST(EstimateNormals, OfPlanesAreExactAndOfTooFewPointsAny) {
  evenmesh::ExecutionContext context(1);
  std::vector<Vec3> points;
  const Vec3 u = normalized({2, 1, 0}), v = normalized({-1, 2, 3}), n = normalized(cross(u, v));
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j) points.push_back(0.1 * i * u + 0.1 * j * v);
  Box box;
  for (const Vec3& p : points) box.add(p);
  points.push_back(box.lo + Vec3{0.1, 0.1, 0.1});  // alone in its corner, perhaps
  SiteVoxels sites = voxelize_points(points, {}, make_voxel_grid(box, 30, 6), context);
  estimate_normals(sites, 3, context);
  std::size_t off = 0;
  for_sites(sites, [&](std::size_t i, const Vec3&) {
    EXPECT_NEAR(norm(unpack_normal(sites.normal[i])), 1, 1e-3);
    off += std::abs(dot(unpack_normal(sites.normal[i]), n)) < 0.999;
  });
  EXPECT_LE(off, 20u) << "those near the odd one";
}

TEST(BridgePoints, MakeAClosedSphereOfRandomPoints) {
  for (const bool oriented : {true, false})
    for (const std::size_t resolution : {32u, 64u}) {
      SCOPED_TRACE(testing::Message() << oriented << ' ' << resolution);
      evenmesh::ExecutionContext context(2);
      const Bridged made = bridged(ball_of_points(3000), oriented, resolution, 2);
      const double h = made.sites.grid.side;
      expect_well_formed(made.sites);
      EXPECT_GT(made.sites.size(), made.sparse.size());
      std::size_t far = 0, tilted = 0;
      for_sites(made.sites, [&](std::size_t i, const Vec3& p) {
        far += std::abs(norm(p) - 1) > h;
        const double along = dot(unpack_normal(made.sites.normal[i]), normalized(p));
        tilted += (oriented ? along : std::abs(along)) < 0.9;
      });
      EXPECT_EQ(far, 0u);
      EXPECT_EQ(tilted, 0u);
      // Closed: a shell of one voxel separates inside from outside.
      EXPECT_EQ(cavities_of(build_narrow_band(made.sites, 1, context)), 1u);
    }
}

TEST(BridgePoints, EndsWhereThePointsEnd) {
  PointCloud cloud = ball_of_points(6000);
  std::erase_if(cloud.points, [](const Vec3& p) { return p.z < 0; });
  const Bridged made = bridged(cloud, true, 48, 2);
  double lowest = 1;
  for_sites(made.sites, [&](std::size_t, const Vec3& p) { lowest = std::min(lowest, p.z); });
  EXPECT_LT(lowest, 0.1);
  EXPECT_GT(lowest, -made.spacing - 2 * made.sites.grid.side);
}

TEST(BridgePoints, SameBytesForAnyNumberOfThreads) {
  expect_same(bridged(ball_of_points(2000), false, 40, 1).sites, bridged(ball_of_points(2000), false, 40, 3).sites);
}

}  // namespace
}  // namespace evenmesh
