// Broken triangle meshes: what is a solid, what is not, and what is said of it.

#include <utility>

#include "evenmesh/solid.h"
#include "pipeline/shell_testing.h"

namespace evenmesh {
namespace {

constexpr Box unit_box{{0, 0, 0}, {1, 1, 1}};

MeshResult quickly(const Mesh& mesh, std::size_t vertices = 600, unsigned threads = 2) {
  return meshed(shape_from_mesh(mesh), {.vertices = vertices, .quality = Quality::fast}, threads);
}

Mesh inside_out(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// The fin of a block, [0, 1]² × [0, 0.4].
Mesh block_with_fin() {
  const Mesh fin{{{0.5, 0, 0.2}, {0.5, 1, 0.2}, {0.5, 1, 1.2}, {0.5, 0, 1.2}}, {{0, 1, 2}, {0, 2, 3}}};
  return merged(make_box_around({{0, 0, 0}, {1, 1, 0.4}}), fin);
}

const Finding& finding(const Report& report, FindingCode code) {
  return *std::find_if(report.findings.begin(), report.findings.end(),
                       [&](const Finding& f) { return f.code == code; });
}

TEST(Judge, ACubeWithoutATriangleIsACube) {
  for (const int cuts : {1, 5}) {
    Mesh mesh = make_box_around(unit_box, cuts);
    mesh.triangles.erase(mesh.triangles.begin());
    const MeshResult result = quickly(mesh);
    expect_good_mesh(result);
    EXPECT_NEAR(result.report.quality.volume, 1, 1e-3);
    EXPECT_NEAR(result.report.quality.area, 6, 1e-2);
    EXPECT_EQ(result.report.quality.euler, 2);
    EXPECT_NEAR(result.report.crease_length, 12, 0.01);
    EXPECT_EQ(result.report.disagreements, 0u);
    ASSERT_TRUE(has_finding(result.report, FindingCode::holes_filled));
    const Finding& hole = finding(result.report, FindingCode::holes_filled);
    EXPECT_TRUE(hole.place);
    EXPECT_NE(hole.sentence.find("1 hole was filled"), std::string::npos) << hole.sentence;
  }
}

TEST(Judge, HolesStayOpenForTheShell) {
  Mesh mesh = make_box_around(unit_box);
  mesh.triangles.erase(mesh.triangles.begin());
  const MeshResult result = meshed(shape_from_mesh(mesh), by_shell(600));
  EXPECT_GT(result.report.quality.boundary_edges, 0u);
  EXPECT_FALSE(has_finding(result.report, FindingCode::holes_filled));
}

TEST(Judge, MouthsStayOpen) {
  Mesh cup = make_box_around(unit_box, 4);
  std::erase_if(cup.triangles, [&](const Triangle& t) {
    return cup.vertices[t[0]].z + cup.vertices[t[1]].z + cup.vertices[t[2]].z > 2.999;
  });
  const MeshResult result = quickly(cup);
  EXPECT_GT(result.report.quality.boundary_edges, 0u);
  EXPECT_FALSE(has_finding(result.report, FindingCode::holes_filled));
}

TEST(Judge, APartInsideOutIsTurned) {
  const Mesh a = make_box_around(unit_box);
  const MeshResult result = quickly(merged(a, inside_out(translated(a, {0.5, 0.5, 0.5}))));
  expect_good_mesh(result);
  EXPECT_NEAR(result.report.quality.volume, 1.875, 0.01);
  EXPECT_EQ(result.report.quality.euler, 2);
  ASSERT_TRUE(has_finding(result.report, FindingCode::parts_turned));
  EXPECT_NEAR(norm(*finding(result.report, FindingCode::parts_turned).place - Vec3{1, 1, 1}), 0, 1e-9);
}

TEST(Judge, TouchingBodiesAreOneAndNothingIsLost) {
  const Mesh a = make_box_around(unit_box);
  const Mesh three = merged(a, merged(translated(a, {1, 0, 0}), translated(a, {2, 0, 0})));
  const MeshResult result = quickly(three);
  expect_good_mesh(result);
  EXPECT_NEAR(result.report.quality.volume, 3, 0.01);
  EXPECT_EQ(result.report.quality.components, 1u);
  EXPECT_FALSE(has_finding(result.report, FindingCode::crossings_unresolved)) << "nothing lies between the faces";
}

TEST(Judge, AFinIsNamedAndTheBlockKeepsItsEdges) {
  const MeshResult result = quickly(block_with_fin());
  EXPECT_TRUE(result.report.quality.closed());
  EXPECT_NEAR(result.report.quality.volume, 0.4, 1e-3);
  EXPECT_NEAR(result.report.crease_length, 4 * 2.4, 0.01);
  EXPECT_EQ(result.report.disagreements, 0u);
  EXPECT_TRUE(breaks_a_promise(result.report));
  ASSERT_TRUE(has_finding(result.report, FindingCode::sheets_left_out));
  const Finding& fin = finding(result.report, FindingCode::sheets_left_out);
  EXPECT_NEAR(norm(*fin.place - Vec3{0.5, 0.5, 0.7}), 0, 1e-9);
  const MeshResult again = quickly(block_with_fin(), 600, 1);
  EXPECT_EQ(result.mesh.vertices, again.mesh.vertices);
  EXPECT_EQ(result.mesh.triangles, again.mesh.triangles);
}

TEST(Judge, FlakesBreakNoPromise) {
  const Mesh flake{{{0.5, 0.5, 1}, {0.52, 0.5, 1}, {0.5, 0.5, 1.02}}, {{0, 1, 2}}};
  const MeshResult result = quickly(merged(make_box_around(unit_box), flake));
  expect_good_mesh(result);
  EXPECT_TRUE(has_finding(result.report, FindingCode::flakes_left_out));
}

TEST(Judge, MoreSheetsThanSolidAreSheets) {
  const Mesh mesh = merged(make_box_around({{0, 0, 1}, {0.2, 0.2, 1.2}}), make_grid_plane(4, 4));
  const MeshResult result = quickly(mesh);
  EXPECT_GT(result.report.sheets, 0u);
  EXPECT_FALSE(has_finding(result.report, FindingCode::sheets_left_out));
}

TEST(Judge, OperandsAreJudgedToo) {
  Mesh holed = make_box_around(unit_box);
  holed.triangles.erase(holed.triangles.begin());
  const Shape cut = subtract(shape_from_mesh(holed), {shape_from_box({{0.5, 0.5, 0.5}, {2, 2, 2}})});
  const MeshResult result = meshed(cut, {.vertices = 600, .quality = Quality::fast});
  expect_good_mesh(result);
  EXPECT_NEAR(result.report.quality.volume, 0.875, 0.01);
  EXPECT_TRUE(has_finding(result.report, FindingCode::holes_filled));
}

TEST(Judge, NarrowGapsThatHideMuchAreFilledWithCavities) {
  // A stack of plates: between them it is narrower than an edge.
  Mesh stack = make_box_around({{0, 0, 0}, {1, 1, 0.1}});
  for (int i = 1; i < 6; ++i) stack = merged(stack, make_box_around({{0, 0, 0.13 * i}, {1, 1, 0.13 * i + 0.1}}));
  MeshOptions options{.vertices = 500, .method = Method::raster, .quality = Quality::fast};
  options.fill_cavities = true;
  const MeshResult result = meshed(shape_from_mesh(stack), options);
  EXPECT_TRUE(result.report.quality.closed());
  EXPECT_TRUE(has_finding(result.report, FindingCode::narrow_gaps_filled));
  EXPECT_EQ(result.report.quality.components, 1u);
  EXPECT_NEAR(result.report.quality.volume, 0.7, 0.06);
}

}  // namespace
}  // namespace evenmesh
