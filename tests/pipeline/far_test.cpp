/// Models far from the origin come out as they do at the origin.

#include "evenmesh/points.h"
#include "evenmesh/solid.h"
#include "pipeline/shell_testing.h"

namespace evenmesh {
namespace {

const Vec3 survey{400000, 800000, 0};
/// Not a number that single precision holds to the centimetre.
const Vec3 odd{691003.37, 5336001.21, 519.3};

Shape kerb() {
  return unite({shape_from_box({{0, 0, 0}, {0.6, 0.3, 2}}), shape_from_box({{0, 0, 0}, {0.3, 0.55, 2}})});
}

void expect_same_up_to(const MeshResult& far, const MeshResult& near, const Vec3& by, double error) {
  ASSERT_EQ(far.mesh.triangles, near.mesh.triangles);
  for (std::size_t v = 0; v < far.mesh.vertices.size(); ++v)
    ASSERT_LT(norm(far.mesh.vertices[v] - by - near.mesh.vertices[v]), error) << v;
  EXPECT_NEAR(far.report.quality.volume, near.report.quality.volume, 1e-6 * near.report.quality.area);
  EXPECT_NEAR(far.report.quality.q_min, near.report.quality.q_min, 1e-5);
}

TEST(FarAway, SolidsAreThoseAtTheOrigin) {
  const MeshResult near = meshed(kerb(), {.vertices = 600});
  const MeshResult far = meshed(transformed(kerb(), Affine::translate(survey)), {.vertices = 600});
  expect_good_mesh(far);
  expect_same_up_to(far, near, survey, 1e-4 * near.report.quality.edge_length_avg);
}

TEST(FarAway, SolidsKeepTheirFigures) {
  for (const Vec3& by : {survey, odd}) {
    const MeshResult result = meshed(transformed(kerb(), Affine::translate(by)), {.vertices = 600});
    expect_good_mesh(result);
    EXPECT_NEAR(result.report.quality.volume, 2 * (0.6 * 0.3 + 0.3 * 0.25), 1e-4);
    EXPECT_GT(result.report.quality.q_min, 0.5);
  }
}

TEST(FarAway, PointsAndSheetsKeepTheirFigures) {
  PointCloud cloud = ball_of_points(3000, false);
  for (Vec3& p : cloud.points) p += odd;
  const MeshResult ball = meshed(shape_from_points(cloud), {.vertices = 400});
  expect_good_sheet(ball);
  EXPECT_EQ(ball.report.quality.euler, 2);
  EXPECT_NEAR(ball.report.quality.area, 4 * std::numbers::pi, 0.4);
  const Mesh square{{odd, odd + Vec3{1, 0, 0}, odd + Vec3{1, 1, 0}, odd + Vec3{0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const MeshResult sheet = meshed(shape_from_mesh(square), {.vertices = 300, .method = Method::shell});
  expect_good_sheet(sheet);
  EXPECT_NEAR(sheet.report.quality.area, 1, 0.03);
  EXPECT_NEAR(sheet.report.quality.bounds.center().x, odd.x + 0.5, 0.01);
}

TEST(FarAway, ExpressionsAndDensityCountFromTheCallersOrigin) {
  const auto ball = [](double x) {
    return shape_from_expression("(x - c)^2 + y^2 + z^2 - 1", {{"c", x}}, {{x - 2, -2, -2}, {x + 2, 2, 2}});
  };
  const auto options = [](double x) {
    return MeshOptions{.vertices = 500, .density = [x](const Vec3& p) { return p.x > x ? 4.0 : 1.0; }};
  };
  const double x = 5e6;
  const MeshResult near = meshed(ball(0), options(0)), far = meshed(ball(x), options(x));
  expect_good_mesh(far);
  const auto right = [](const Mesh& mesh, double middle) {
    return std::count_if(mesh.vertices.begin(), mesh.vertices.end(), [&](const Vec3& v) { return v.x > middle; });
  };
  EXPECT_NEAR(double(right(far.mesh, x)), double(right(near.mesh, 0)), 10);
  EXPECT_NEAR(far.report.quality.volume, near.report.quality.volume, 0.01);
}

TEST(FarAway, WhatIsKeptIsInTheCallersCoordinates) {
  Artifacts kept;
  kept.dexels.emplace();
  mesh_shape(transformed(kerb(), Affine::translate(survey)), {.vertices = 300}, ExecutionContext::silent(), &kept);
  ASSERT_TRUE(kept.dexels);
  const MeshResult again = meshed(shape_from_dexels(*kept.dexels), {.vertices = 300});
  EXPECT_NEAR(again.report.quality.bounds.lo.x, survey.x, 0.02);
  EXPECT_NEAR(again.report.quality.bounds.lo.y, survey.y, 0.02);
}

TEST(FarAway, PlacesInFindingsTellNeighboursApart) {
  EXPECT_NE(make_finding(FindingCode::sheets_merged, {{"width", 1.0}, {"count", 1.0}, {"cure", std::string("x")}}, odd)
                .sentence.find("(691003.37, 5336001.21, 519.3)"),
            std::string::npos);
}

}  // namespace
}  // namespace evenmesh
