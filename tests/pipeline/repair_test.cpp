#include "evenmesh/repair.h"

#include "pipeline/shell_testing.h"

namespace evenmesh {
namespace {

MeshResult filled(const Mesh& mesh, std::size_t vertices, Winding winding = Winding::any) {
  Shape shape = shape_from_mesh(mesh);
  shape.winding = winding;
  MeshOptions options{.vertices = vertices, .method = Method::raster, .quality = Quality::fast};
  options.fill_cavities = true;
  return meshed(shape, options);
}
Mesh inside_out(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TEST(Repair, SolidityTellsSheetsFromSolidsWithHoles) {
  EXPECT_EQ(solidity(make_icosphere(4)), 1);
  EXPECT_EQ(solidity(merged(make_icosphere(3), translated(make_icosphere(3), {0.8, 0, 0}))), 1);
  EXPECT_GT(solidity(damaged(make_icosphere(5), {.lost = 60}, 1)), 0.8);
  EXPECT_LT(solidity(hemisphere(4)), 0.4);
  EXPECT_LT(solidity(plate({0, 0, 0}, {1, 0, 0.1}, {0, 1, 0.2})), 0.1);
}

TEST(Repair, InnerShellsAndCavitiesAreFilled) {
  // A hollow ball with a ball in its hollow, and another one beside it.
  const Mesh hollow = merged(make_icosphere(4), inside_out(make_icosphere(4, 0.6)));
  const Mesh all = merged(merged(hollow, make_icosphere(3, 0.3)), translated(make_icosphere(3, 0.4), {1.8, 0, 0}));
  const MeshResult result = filled(all, 1500);
  expect_good_mesh(result);
  EXPECT_EQ(result.report.quality.components, 2u);
  EXPECT_EQ(result.report.filled_cavities, 2u);
  EXPECT_NEAR(result.report.quality.volume, 4.0 / 3 * std::numbers::pi * (1 + 0.064), 0.05);
  MeshOptions keep{.vertices = 1500, .quality = Quality::fast};
  EXPECT_EQ(meshed(shape_from_mesh(all), keep).report.quality.components, 4u);
}

TEST(Repair, PartsThatFaceInwardBoundNothingWhenAsked) {
  const Mesh both = merged(make_icosphere(4), inside_out(translated(make_icosphere(4), {1.2, 0, 0})));
  const MeshResult oriented = filled(both, 800, Winding::positive), any = filled(both, 800);
  EXPECT_NEAR(oriented.report.quality.volume, 4.0 / 3 * std::numbers::pi * (1 - 0.208), 0.2)
      << "the second ball takes its part out of the first";
  EXPECT_GT(any.report.quality.volume, 4.4);
}

TEST(Repair, HolesAreClosed) {
  const Mesh holed =
      damaged(make_torus(1, 0.4, 80, 40), {.lost = 120, .repeated = 300, .degenerate = 60, .fins = 20}, 3);
  MeshDefects defects;
  const MeshResult result = filled(cleaned(holed, defects), 1500);
  EXPECT_TRUE(result.report.quality.closed());
  EXPECT_TRUE(result.report.quality.two_manifold());
  EXPECT_EQ(result.report.self_intersections, 0u);
  EXPECT_TRUE(has_finding(result.report, FindingCode::sheets_left_out)) << "the fins";
  EXPECT_GT(defects.boundary_edges, 50u);
  EXPECT_EQ(result.report.quality.components, 1u);
  EXPECT_EQ(result.report.quality.euler, 0);
  EXPECT_NEAR(result.report.quality.volume, 2 * std::numbers::pi * std::numbers::pi * 0.16, 0.12);
}

TEST(Repair, FilledHolesLeaveNothingToVoteOn) {
  Mesh holed = make_icosphere(5);
  for (const Vec3& hole : {Vec3{0, 0, -1}, Vec3{0.6, 0, -0.8}, Vec3{0, 0.8, 0.6}})
    std::erase_if(holed.triangles, [&](const Triangle& t) {
      return norm((holed.vertices[t[0]] + holed.vertices[t[1]] + holed.vertices[t[2]]) / 3 - hole) < 0.25;
    });
  std::size_t count = 0;
  for (const std::size_t vertices : {1000u, 4000u}) {
    const MeshResult result = filled(holes_filled(holed, count), vertices);
    EXPECT_EQ(count, 3u);
    expect_good_mesh(result);
    EXPECT_EQ(result.report.disagreements, 0u);
    EXPECT_EQ(result.report.quality.euler, 2);
  }
}

}  // namespace
}  // namespace evenmesh
