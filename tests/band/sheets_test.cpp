#include "band/sheets.h"

#include <numbers>

#include "band/band_checks.h"
#include "connect/connect_testing.h"
#include "grid/blocks.h"
#include "grid/surface_components.h"

namespace evenmesh {
namespace {

constexpr double pi = std::numbers::pi;

struct Chosen {
  BandOf made;
  Sheets sheets;
  SampleSet samples;  ///< the chosen ones, drawn onto the surface

  /// Area of the chosen samples as they lie on the shell's border, and of those where use(position) is true.
  template <typename Where>
  double area(const Where& where) const {
    double sum = 0;
    for_samples(made.surface.samples, [&](std::size_t i, const Vec3& p) {
      if (sheets.chosen[i] && where(p)) sum += made.surface.samples.area[i];
    });
    return sum;
  }
  double area() const {
    return area([](const Vec3&) { return true; });
  }
};

Chosen chosen(const Mesh& mesh, std::size_t resolution, unsigned threads = 2, double min_area = 0) {
  evenmesh::ExecutionContext context(threads);
  Chosen result{band_of(mesh, resolution, 2, threads), {}, {}};
  result.sheets = choose_sheets(result.made.surface, result.made.sites, min_area, context);
  std::vector<std::uint32_t> index;
  for (std::uint32_t i = 0; i < result.sheets.chosen.size(); ++i)
    if (result.sheets.chosen[i]) index.push_back(i);
  result.samples = drawn_onto_surface(gather(result.made.surface.samples, index), index, result.made.surface,
                                      result.made.sites, context);
  return result;
}

/// The parallelogram at `corner` along u and v.
Mesh plate(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return {{corner, corner + u, corner + u + v, corner + v}, {{0, 1, 2}, {0, 2, 3}}};
}
Mesh flipped(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// What a boundary of that length may add to the area, or take away: three voxels along it.
double of_rim(const Chosen& c, double length) {
  return 3 * c.made.sites.grid.side * length;
}

/// How far the farthest site lies from a chosen sample, drawn onto the surface, in voxels.
double farthest_site(const Chosen& c) {
  std::vector<Vec3> points;
  for_samples(c.samples, [&](std::size_t, const Vec3& p) { points.push_back(p); });
  double farthest = 0;
  for_sites(c.made.sites, [&](std::size_t, const Vec3& site) {
    double nearest = 1e300;
    for (const Vec3& p : points) nearest = std::min(nearest, squared_norm(p - site));
    farthest = std::max(farthest, nearest);
  });
  return std::sqrt(farthest) / c.made.sites.grid.side;
}

TEST(Sheets, ShellsAreSolids) {
  // Of a closed surface two parts; of an open one, whatever its genus, one.
  evenmesh::ExecutionContext context(2);
  const struct {
    Mesh mesh;
    std::size_t parts;
  } known[] = {{make_icosphere(3), 2}, {make_torus(), 2}, {make_grid_plane(3, 2), 1}};
  for (const auto& [mesh, parts] : known) {
    const SurfaceComponents found = surface_components(band_of(mesh, 40, 2).surface.samples, context);
    EXPECT_EQ(found.area.size(), parts);
  }
}

TEST(Sheets, OfAClosedSurfaceTheOuterIsTaken) {
  for (const Mesh& mesh : {make_icosphere(4), flipped(make_icosphere(4))}) {
    const Chosen c = chosen(mesh, 48);
    EXPECT_EQ(c.sheets.sheets, 1u);
    EXPECT_EQ(c.sheets.cut, 0u);
    EXPECT_EQ(std::count(c.sheets.border.begin(), c.sheets.border.end(), 1), 0) << "no rim";
    std::size_t inward = 0;
    for_samples(c.samples,
                [&](std::size_t i, const Vec3& p) { inward += dot(unpack_normal(c.samples.normal[i]), p) < 0; });
    EXPECT_EQ(inward, 0u);
    const double d = 2.5 * c.made.sites.grid.side;
    EXPECT_NEAR(c.area(), 4 * pi * (1 + d) * (1 + d), 0.03 * 4 * pi);
    EXPECT_LT(farthest_site(c), 2.5);
  }
}

TEST(Sheets, OfAPlateOneSideIsTaken) {
  const Vec3 directions[][2] = {{{1, 0, 0}, {0, 1, 0}}, {{1, 0.3, 0.2}, {-0.3, 0.9, 0.3}}, {{0.7, 0, 0.7}, {0, 1, 0}}};
  for (const auto& [u, v] : directions) {
    const Chosen c = chosen(plate({0, 0, 0}, u, v), 60);
    const Vec3 n = normalized(cross(u, v));
    const double area = norm(cross(u, v));
    EXPECT_EQ(c.sheets.sheets, 1u);
    EXPECT_EQ(c.sheets.cut, 0u);
    EXPECT_NEAR(c.area(), area, of_rim(c, 2 * (norm(u) + norm(v)))) << "the shell is wider than the plate";
    std::size_t behind = 0;
    for_samples(c.samples,
                [&](std::size_t i, const Vec3&) { behind += dot(unpack_normal(c.samples.normal[i]), n) < 0; });
    EXPECT_EQ(behind, 0u) << "the side that the triangles face";
    EXPECT_GT(std::count(c.sheets.border.begin(), c.sheets.border.end(), 1), 4 * 40);
    EXPECT_LT(farthest_site(c), 2.5);
  }
}

TEST(Sheets, BordersAreChosenAndNextToWhatIsNot) {
  const Chosen c = chosen(plate({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 40);
  const double h = c.made.sites.grid.side;
  std::size_t wrong = 0;
  for_samples(c.made.surface.samples, [&](std::size_t i, const Vec3& p) {
    if (!c.sheets.border[i]) return;
    wrong += !c.sheets.chosen[i];
    const double to_rim = std::min({p.x, p.y, 1 - p.x, 1 - p.y});
    wrong += to_rim > 3 * h;
  });
  EXPECT_EQ(wrong, 0u);
}

TEST(Sheets, ParallelPlatesAreTwoSheets) {
  const Mesh one = plate({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (const Mesh& other : {translated(one, {0, 0, 0.2}), flipped(translated(one, {0, 0, 0.2}))}) {
    const Chosen c = chosen(merged(one, other), 50);  // ten voxels apart
    EXPECT_EQ(c.sheets.sheets, 2u);
    EXPECT_EQ(c.sheets.cut, 0u);
    for (const bool upper : {false, true})
      EXPECT_NEAR(c.area([&](const Vec3& p) { return (p.z > 0.1) == upper; }), 1, of_rim(c, 4));
    EXPECT_LT(farthest_site(c), 2.5);
  }
}

TEST(Sheets, AJunctionIsCoveredAndCut) {
  Mesh t = merged(plate({-1, 0, 0}, {1, 0, 0}, {0, 1, 0}), plate({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  t = merged(t, plate({0, 0, 0}, {0, 1, 0}, {0, 0, 1}));
  const Chosen c = chosen(t, 60);
  EXPECT_GE(c.sheets.sheets, 2u);
  EXPECT_GE(c.sheets.cut, 1u);
  EXPECT_NEAR(c.area(), 3, of_rim(c, 8));
  EXPECT_LT(farthest_site(c), 5);
}

TEST(Sheets, SmallOnesAreDropped) {
  const Mesh mesh = merged(make_icosphere(4), plate({2, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0}));
  EXPECT_EQ(chosen(mesh, 60).sheets.dropped, 0u);
  const Chosen c = chosen(mesh, 60, 2, 0.5);
  EXPECT_GE(c.sheets.dropped, 1u);
  EXPECT_EQ(c.sheets.sheets, 1u);
  EXPECT_EQ(c.area([](const Vec3& p) { return p.x > 1.6; }), 0);
}

TEST(Sheets, OuterSidesAreClosed) {
  evenmesh::ExecutionContext context(2);
  // A ball within a ball, and a plate beside them: what floods in from outside sees the larger ball and the plate.
  Mesh mesh = merged(make_icosphere(4), make_icosphere(3, 0.5));
  mesh = merged(mesh, plate({1.5, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}));
  const BandOf made = band_of(mesh, 80, 2);
  const Sheets outer = outer_sheets(made.surface, context);
  EXPECT_EQ(std::count(outer.border.begin(), outer.border.end(), 1), 0);
  std::size_t inward = 0;
  for_samples(made.surface.samples, [&](std::size_t i, const Vec3& p) {
    inward += outer.chosen[i] && p.x < 1.3 && dot(unpack_normal(made.surface.samples.normal[i]), p) < 0;
  });
  EXPECT_EQ(inward, 0u);
  const SampleSet kept = keep_samples(made.surface.samples, [&](std::uint32_t i) { return outer.chosen[i] != 0; });
  EXPECT_EQ(surface_components(kept, context).area.size(), outer.sheets) << "whole parts bound a solid";
}

TEST(Sheets, SameForAnyNumberOfThreads) {
  const Mesh mesh = merged(make_torus(), plate({0, 0, 0}, {1, 0, 0}, {0, 1, 0.4}));
  const Chosen one = chosen(mesh, 60, 1), three = chosen(mesh, 60, 3);
  EXPECT_EQ(one.sheets.chosen, three.sheets.chosen);
  EXPECT_EQ(one.sheets.border, three.sheets.border);
  EXPECT_EQ(one.sheets.sheets, three.sheets.sheets);
  EXPECT_EQ(one.sheets.cut, three.sheets.cut);
}

}  // namespace
}  // namespace evenmesh
