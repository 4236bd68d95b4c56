/// What a run says of inputs that it cannot follow.

#include <map>

#include "evenmesh/error.h"
#include "evenmesh/solid.h"
#include "pipeline/pipeline_testing.h"

namespace evenmesh {
namespace {

std::string refusal(const Shape& shape, const MeshOptions& options = {.vertices = 300}) {
  try {
    meshed(shape, options);
  } catch (const UnusableInput& error) {
    return error.what();
  }
  return "";
}

void expect_words(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << text << "\nlacks " << word;
}

const Finding* finding(const Report& report, FindingCode code) {
  for (const Finding& f : report.findings)
    if (f.code == code) return &f;
  return nullptr;
}

Shape sheet() {
  return shape_from_mesh(make_grid_plane(8, 8, 0.25), "sheet.off");
}

TEST(Said, SheetsHaveNoInsideToGrow) {
  expect_words(refusal(offset(sheet(), 0.05)),
               {"sheet.off is an open sheet", "no inside", "about 0.1 thick", "evenmesh wrap sheet.off -r 40"});
  expect_words(refusal(unite({gallery_shape("sphere"), sheet()})), {"sheet.off", "no inside", "evenmesh wrap"});
  EXPECT_EQ(refusal(offset(shape_from_mesh(make_icosphere(2)), 0.1)), "");
  Mesh holed = make_icosphere(3);
  holed.triangles.pop_back();
  EXPECT_EQ(refusal(offset(shape_from_mesh(holed), 0.1)), "") << "a hole does not make a sheet";
}

TEST(Said, PiecesThatNoRayHitsAreCounted) {
  Mesh mesh = make_icosphere(3);
  std::size_t outside = 0;
  // Specks on a lattice around the ball, and some within it, which are no surface of the solid.
  for (int i = 0; i < 1000; ++i) {
    const Vec3 at{-1.83 + 0.411 * (i % 10), -1.87 + 0.407 * (i / 10 % 10), -1.79 + 0.413 * (i / 100)};
    if (std::abs(norm(at) - 1) < 0.05) continue;
    mesh = merged(mesh, translated(make_tetrahedron(0.003), at));
    outside += norm(at) > 1;
  }
  const Report report = meshed(shape_from_mesh(mesh), {.vertices = 400}).report;
  EXPECT_EQ(report.dropped_components, outside);
  ASSERT_NE(finding(report, FindingCode::small_components_dropped), nullptr);
  EXPECT_EQ(
      meshed(shape_from_mesh(merged(make_icosphere(3), translated(make_icosphere(2), {3, 0, 0}))), {.vertices = 400})
          .report.dropped_components,
      0u);
}

TEST(Said, SurfacesWithOneSide) {
  // A figure eight that is turned over once on its way around: a Klein bottle.
  constexpr std::uint32_t around = 60, across = 30;
  Mesh mesh;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double a = std::sin(v), b = std::sin(2 * v), r = 2 + std::cos(u / 2) * a - std::sin(u / 2) * b;
      mesh.vertices.push_back({r * std::cos(u), r * std::sin(u), std::sin(u / 2) * a + std::cos(u / 2) * b});
    }
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return i < around ? i * across + j % across : (across - j % across) % across;
  };
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  for (const Method method : {Method::raster, Method::shell}) {
    const Report report = meshed(shape_from_mesh(mesh), {.vertices = 1500, .method = method}).report;
    const Finding* said = finding(report, FindingCode::one_sided);
    ASSERT_NE(said, nullptr);
    expect_words(said->sentence, {"3600 triangles", "one side only"});
  }
}

TEST(Said, EdgesLongerThanTheRadiusOfCurvature) {
  // A sphere with so few vertices that edges are as long as its radius, and with enough.
  const Shape ball = gallery_shape("sphere");
  const Report coarse = meshed(ball, {.vertices = 10}).report;
  EXPECT_NE(finding(coarse, FindingCode::coarser_than_curvature), nullptr);
  for (const std::size_t vertices : {50u, 1000u})
    EXPECT_EQ(finding(meshed(ball, {.vertices = vertices}).report, FindingCode::coarser_than_curvature), nullptr);
  // Sharp edges that the mesh has are none of that.
  EXPECT_EQ(finding(meshed(gallery_shape("cube"), {.vertices = 60}).report, FindingCode::coarser_than_curvature),
            nullptr);
}

TEST(Said, PointsThatShowNoSurface) {
  PointCloud corners;
  for (int i = 0; i < 8; ++i) corners.points.push_back({i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0});
  expect_words(refusal(shape_from_points(corners, "corners.xyz")), {"corners.xyz", "points show no surface"});
}

}  // namespace
}  // namespace evenmesh
