#include "band/narrow_band.h"

#include <gtest/gtest.h>

#include "core/instruction_sets.h"
#include "evenmesh/error.h"
#include "geometry/primitives.h"
#include "voxel_checks.h"

namespace evenmesh {
namespace {

/// Sites at the given voxels.
SiteVoxels sites_at(const std::set<Voxel>& voxels, const VoxelGrid& grid) {
  std::vector<Vec3> points;
  for (const Voxel& v : voxels) points.push_back(grid.center(v));
  return voxelize_points(points, {}, grid);
}

std::set<Voxel> random_voxels(const VoxelGrid& grid, std::size_t count, Random& random) {
  std::set<Voxel> voxels;
  while (voxels.size() < count) {
    Voxel v{};
    for (std::size_t a = 0; a < 3; ++a) v[a] = std::int32_t(random.below(grid.size[a]));
    voxels.insert(v);
  }
  return voxels;
}

std::uint32_t squared_distance(const Voxel& a, const Voxel& b) {
  const std::int32_t x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return std::uint32_t(x * x + y * y + z * z);
}

/// Which site the transform must name: by distance, then z, y, x.
struct Nearest {
  std::uint32_t squared = ~0u;
  Voxel site{};
};
std::vector<Nearest> by_brute_force(const std::set<Voxel>& sites, const VoxelGrid& grid) {
  const std::vector<Voxel> by_x(sites.begin(), sites.end());
  std::vector<Voxel> list = by_x;
  std::sort(list.begin(), list.end(), [](const Voxel& a, const Voxel& b) {
    return std::array{a[2], a[1], a[0]} < std::array{b[2], b[1], b[0]};
  });
  std::vector<Nearest> nearest;
  for_all_voxels(grid, [&](const Voxel& v) {
    Nearest best;
    for (const Voxel& s : list)
      if (const std::uint32_t squared = squared_distance(v, s); squared < best.squared) best = {squared, s};
    nearest.push_back(best);
  });
  return nearest;
}

void expect_exact(const NarrowBand& band, const SiteVoxels& sites, const std::vector<Nearest>& expected) {
  std::size_t i = 0, wrong = 0, voxels = 0;
  const std::uint32_t limit = band.reach() * band.reach();
  for_all_voxels(band.grid(), [&](const Voxel& v) {
    const Nearest& best = expected[i++];
    const NearestSite* found = band.find(v);
    if ((found != nullptr) != (best.squared <= limit) || (found != nullptr) != band.tiles().contains(v)) ++wrong;
    if (found == nullptr) return;
    ++voxels;
    if (found->squared_distance() != best.squared || found->site(v) != best.site) ++wrong;
    if (site_index(sites, v, *found) != sites.tiles.number(best.site)) ++wrong;
  });
  EXPECT_EQ(wrong, 0u) << "reach " << band.reach();
  EXPECT_EQ(voxels, band.size());
}

TEST(NarrowBand, IsExactForRandomSitesAndAllReaches) {
  Random random(1);
  // Sizes at which tiles and blocks end in the grid, and before and behind its border.
  for (const auto& grid : {unit_voxels(17, 16, 15), unit_voxels(24, 9, 33)})
    for (const std::size_t count : {1u, 12u, 150u}) {
      const std::set<Voxel> voxels = random_voxels(grid, count, random);
      const SiteVoxels sites = sites_at(voxels, grid);
      const std::vector<Nearest> expected = by_brute_force(voxels, grid);
      for (unsigned d = 1; d <= 20; ++d) {
        const NarrowBand band = build_narrow_band(sites, d);
        expect_well_formed(band.tiles(), grid);
        expect_exact(band, sites, expected);
      }
    }
}

TEST(NarrowBand, IsExactForSitesAtTileBorders) {
  const VoxelGrid grid = unit_voxels(40, 40, 40);
  for (const std::int32_t at : {0, 7, 8, 15, 16, 39}) {
    const std::set<Voxel> voxels{{at, 16, 15}, {16, at, 16}, {15, 16, at}, {at, at, at}};
    const SiteVoxels sites = sites_at(voxels, grid);
    const std::vector<Nearest> expected = by_brute_force(voxels, grid);
    for (const unsigned d : {1u, 3u, 8u, 9u, 16u, 17u, 20u}) expect_exact(build_narrow_band(sites, d), sites, expected);
  }
}

TEST(NarrowBand, ABallAroundOneSite) {
  const VoxelGrid grid = unit_voxels(60, 60, 60);
  const SiteVoxels sites = sites_at({{31, 32, 33}}, grid);
  for (unsigned d = 1; d <= 20; ++d) {
    std::size_t ball = 0;
    for_all_voxels(grid, [&](const Voxel& v) { ball += squared_distance(v, {31, 32, 33}) <= d * d; });
    EXPECT_EQ(build_narrow_band(sites, d).size(), ball);
  }
}

TEST(NarrowBand, TiesGoToTheFirstSiteByZThenYThenX) {
  const VoxelGrid grid = unit_voxels(20, 20, 20);
  const Voxel center{9, 9, 9};
  const std::set<Voxel> all{{6, 9, 9}, {12, 9, 9}, {9, 6, 9}, {9, 12, 9}, {9, 9, 6}, {9, 9, 12}};
  const std::vector<Voxel> order{{9, 9, 6}, {9, 6, 9}, {6, 9, 9}, {12, 9, 9}, {9, 12, 9}, {9, 9, 12}};
  std::set<Voxel> left = all;
  for (const Voxel& first : order) {
    EXPECT_EQ(build_narrow_band(sites_at(left, grid), 3).find(center)->site(center), first);
    left.erase(first);
  }
}

void expect_same(const NarrowBand& a, const NarrowBand& b) {
  ASSERT_TRUE(same_tiles(a.tiles(), b.tiles()));
  for (std::size_t t = 0; t < a.tiles().size(); ++t) {
    const auto u = a.nearest(t), v = b.nearest(t);
    ASSERT_EQ(u.size(), a.tiles()[t].count());
    EXPECT_TRUE(std::equal(u.begin(), u.end(), v.begin(), v.end(),
                           [](NearestSite p, NearestSite q) { return p.bits == q.bits; }));
  }
}

TEST(NarrowBand, ThreadsAndInstructionSetsDoNotMatter) {
  const Mesh mesh = make_torus();
  const SiteVoxels sites = voxelize_mesh(mesh, make_voxel_grid(mesh.bounds(), 120, 6));
  evenmesh::ExecutionContext one(1), two(2);
  const NarrowBand band = build_narrow_band(sites, 5, one);
  expect_same(band, build_narrow_band(sites, 5, two));
  on_every_instruction_set([&](const char*) { expect_same(band, build_narrow_band(sites, 5, one)); });
}

TEST(NarrowBand, HoldsItsSitesAndNamesNeighboursNoFartherThanOneStep) {
  const Mesh mesh = make_torus();
  const VoxelGrid grid = make_voxel_grid(mesh.bounds(), 80, 5);
  const SiteVoxels sites = voxelize_mesh(mesh, grid);
  const NarrowBand band = build_narrow_band(sites, 4);
  std::size_t wrong = 0;
  const std::vector<Voxel> at = voxels_of(sites.tiles);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const NearestSite* found = band.find(at[i]);
    if (found == nullptr || found->squared_distance() != 0 || site_index(sites, at[i], *found) != i) ++wrong;
  }
  for (const Voxel& v : voxels_of(band.tiles())) {
    const double here = std::sqrt(double(band.find(v)->squared_distance()));
    for (int n = 0; n < 27; ++n) {
      const Voxel w{v[0] + n % 3 - 1, v[1] + n / 3 % 3 - 1, v[2] + n / 9 - 1};
      const NearestSite* there = band.find(w);
      const double step = std::sqrt(double(squared_distance(v, w)));
      if (there != nullptr && std::abs(std::sqrt(double(there->squared_distance())) - here) > step + 1e-9) ++wrong;
      if (there == nullptr && here + step <= 4) ++wrong;
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(band.find({-1, 3, 3}), nullptr);
  EXPECT_EQ(band.find({1 << 20, 3, 3}), nullptr);
}

TEST(NarrowBand, MemoryGoesWithTheSurface) {
  std::size_t bytes[2];
  for (const unsigned i : {0u, 1u}) {
    const Mesh mesh = make_icosphere(4);
    const SiteVoxels sites = voxelize_mesh(mesh, make_voxel_grid(mesh.bounds(), i == 0 ? 100 : 200, 4));
    const NarrowBand band = build_narrow_band(sites, 3);
    bytes[i] = band.bytes();
    EXPECT_LT(double(band.bytes()), 8.0 * double(band.size()) + 65536);
  }
  EXPECT_LT(bytes[1], 5 * bytes[0]);
}

TEST(NarrowBand, SaysWhatIsWrong) {
  const VoxelGrid grid = unit_voxels(9, 9, 9);
  const SiteVoxels sites = sites_at({{4, 4, 4}}, grid);
  EXPECT_THROW(build_narrow_band(sites, 0), InvalidInput);
  EXPECT_THROW(build_narrow_band(sites, 21), InvalidInput);
  EXPECT_EQ(build_narrow_band(voxelize_mesh({}, grid), 3).size(), 0u);
  const NarrowBand band = build_narrow_band(sites, 2);
  EXPECT_THROW(site_index(sites_at({{1, 1, 1}}, grid), {4, 4, 5}, *band.find({4, 4, 5})), InvalidInput);
  evenmesh::ExecutionContext context;
  context.cancel();
  EXPECT_THROW(build_narrow_band(sites, 2, context), Cancelled);
  EXPECT_THROW(voxelize_mesh(make_box(), grid, context), Cancelled);
}

}  // namespace
}  // namespace evenmesh
