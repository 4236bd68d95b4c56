#include "pipeline/shell_testing.h"

namespace evenmesh {
namespace {

constexpr double pi = std::numbers::pi;

TEST(PointMeshes, OfABallAreClosed) {
  for (const bool normals : {true, false})
    for (const std::uint64_t seed : {1u, 2u}) {
      SCOPED_TRACE(testing::Message() << normals << ' ' << seed);
      const MeshResult result = meshed(shape_from_points(ball_of_points(3000, normals, seed)), {.vertices = 400});
      expect_good_sheet(result);
      EXPECT_TRUE(result.report.quality.closed()) << boundary_loops(result.mesh) << " holes";
      EXPECT_EQ(result.report.quality.euler, 2);
      EXPECT_GT(result.report.quality.volume, 0) << "outward";
      EXPECT_NEAR(result.report.quality.area, 4 * pi, 0.03 * 4 * pi);
      EXPECT_GT(result.report.quality.q_avg, 0.9);
      EXPECT_TRUE(has_finding(result.report, FindingCode::point_gaps_bridged));
    }
}

TEST(PointMeshes, NoiseIsAveragedOut) {
  PointCloud cloud = ball_of_points(6000, false);
  Random random(7);
  for (Vec3& p : cloud.points) p = p * (1 + 0.01 * random.gaussian());
  const MeshResult result = meshed(shape_from_points(cloud), {.vertices = 300});
  expect_good_sheet(result);
  EXPECT_EQ(result.report.quality.euler, 2);
  EXPECT_NEAR(result.report.quality.area, 4 * pi, 0.05 * 4 * pi);
}

TEST(PointMeshes, OfAHemisphereAreOpen) {
  PointCloud cloud = ball_of_points(6000, false);
  std::erase_if(cloud.points, [](const Vec3& p) { return p.z < 0; });
  for (const bool normals : {false, true}) {
    if (normals) cloud.normals = cloud.points;
    const MeshResult result = meshed(shape_from_points(cloud), {.vertices = 300});
    expect_good_sheet(result);
    EXPECT_EQ(result.report.quality.euler, 1);
    EXPECT_EQ(boundary_loops(result.mesh), 1u);
    EXPECT_NEAR(result.report.quality.area, 2 * pi, 0.1 * 2 * pi);
  }
}

TEST(PointMeshes, RepeatedPointsDoNoHarm) {
  PointCloud cloud = ball_of_points(3000, true);
  const PointCloud once = cloud;
  for (int i = 0; i < 3; ++i) {
    cloud.points.insert(cloud.points.end(), once.points.begin(), once.points.end());
    cloud.normals.insert(cloud.normals.end(), once.normals.begin(), once.normals.end());
  }
  const MeshResult result = meshed(shape_from_points(cloud), {.vertices = 300});
  expect_good_sheet(result);
  EXPECT_EQ(result.report.quality.euler, 2);
}

TEST(PointMeshes, WithoutAreaAreRefused) {
  const std::vector<Vec3> clouds[] = {
      {{1, 2, 3}},
      {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}},
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}},
      {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}, {7, 7, 7}},
      {{0, 0, 0}, {1, 0, 0}},
  };
  for (const auto& points : clouds)
    EXPECT_THROW(meshed(shape_from_points({points, {}}), {.vertices = 100}), UnusableInput) << points.size();
}

}  // namespace
}  // namespace evenmesh
