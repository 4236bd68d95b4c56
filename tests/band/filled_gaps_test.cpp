#include "band/filled_gaps.h"

#include <gtest/gtest.h>

#include "band/band_checks.h"
#include "geometry/primitives.h"

namespace evenmesh {
namespace {

Mesh both(Mesh a, const Mesh& b) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

/// A square of side 40 across direction n, at the given distance from the origin.
Mesh square(const Vec3& n, double distance) {
  const Vec3 u = normalized(cross(n, {0.3, 0.1, 1})), v = cross(n, u), c = distance * n;
  return {{c - 20 * u - 20 * v, c + 20 * u - 20 * v, c + 20 * u + 20 * v, c - 20 * u + 20 * v}, {{0, 1, 2}, {0, 2, 3}}};
}

TEST(FilledGaps, TheThicknessThatKeepsSheetsApartIsSaid) {
  for (const Vec3& n : {Vec3{1, 0, 0}, normalized(Vec3{1, 0.4, 0.2})})
    for (const double width : {3.3, 4.6, 6.2, 9.7, 13.4}) {
      SCOPED_TRACE(width);
      const Mesh mesh = both(square(n, 0), square(n, width));
      const SiteVoxels sites = voxelize_mesh(mesh, make_voxel_grid(mesh.bounds(), 60, 16));
      const double h = sites.grid.side;
      const auto at = [&](unsigned d) { return filled_gaps(build_narrow_band(sites, d), sites); };
      const auto widest = at(12);
      ASSERT_EQ(widest.size(), 1u);
      EXPECT_NEAR(widest[0].width, width, 0.5 * h);
      EXPECT_FALSE(widest[0].sites.empty());
      const unsigned apart = widest[0].kept_apart;
      EXPECT_NEAR(2 * apart + 1, width / h, 3);
      EXPECT_TRUE(apart == 0 || at(apart).empty());
      const auto filled = at(apart + 1);
      ASSERT_FALSE(filled.empty());
      for (const FilledGap& gap : filled) EXPECT_EQ(gap.kept_apart, apart);
    }
}

TEST(FilledGaps, CreasesAndHolesAreNone) {
  const Mesh box = make_box({1, 0.8, 0.6}, 3);
  Mesh holed = make_icosphere(4);
  holed.triangles.resize(holed.triangles.size() - 30);
  const double tilt = 0.35;  // a roof of 40°
  const Mesh roof{{{0, 0, 0},
                   {0, 2, 0},
                   {std::sin(tilt), 2, -std::cos(tilt)},
                   {std::sin(tilt), 0, -std::cos(tilt)},
                   {-std::sin(tilt), 2, -std::cos(tilt)},
                   {-std::sin(tilt), 0, -std::cos(tilt)}},
                  {{0, 1, 2}, {0, 2, 3}, {1, 0, 5}, {1, 5, 4}}};
  for (const Mesh& mesh : {box, holed, roof})
    for (const unsigned d : {1u, 2u, 4u}) {
      const BandOf made = band_of(mesh, 80, d);
      EXPECT_TRUE(filled_gaps(made.band, made.sites).empty()) << mesh.triangles.size() << " triangles, d " << d;
    }
}

TEST(FilledGaps, SameForAnyNumberOfThreads) {
  const Mesh mesh = both(make_icosphere(3, 1.0), make_icosphere(3, 0.93));
  const BandOf made = band_of(mesh, 100, 3);
  evenmesh::ExecutionContext one(1), many(5);
  const auto a = filled_gaps(made.band, made.sites, one), b = filled_gaps(made.band, made.sites, many);
  ASSERT_FALSE(a.empty());
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].width, b[i].width);
    EXPECT_EQ(a[i].sites, b[i].sites);
  }
}

}  // namespace
}  // namespace evenmesh
