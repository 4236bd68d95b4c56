/// Sharp edges of solids: the mesh has edges there.

#include "core/random.h"
#include "evenmesh/solid.h"
#include "pipeline/pipeline_testing.h"

namespace evenmesh {
namespace {

double farthest_crease(const Mesh& mesh, const Mesh& reference) {
  const MeshDistance d = compare_meshes(mesh, reference, {.samples = 20'000});
  EXPECT_GT(d.crease_length, 0);
  return d.crease_max / d.edge_length_avg;
}

TEST(Features, ACubeIsACube) {
  for (const std::size_t vertices : {500u, 5000u}) {
    const MeshResult result = meshed(gallery_shape("cube"), {.vertices = vertices});
    expect_good_mesh(result);
    expect_count(result, vertices);
    EXPECT_EQ(result.report.quality.euler, 2);
    EXPECT_NEAR(result.report.quality.volume, 8, 8e-4);
    EXPECT_NEAR(result.report.quality.area, 24, 24e-4);
    EXPECT_LT(farthest_crease(result.mesh, make_box()), 1e-3);
    EXPECT_GT(result.report.quality.q_avg, 0.88);
    for (const Vec3& v : result.mesh.vertices)
      EXPECT_NEAR(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}), 1, 1e-4);
  }
}

TEST(Features, TriangleMeshesAndFieldsAreTreatedAlike) {
  for (const Shape& shape : {shape_from_mesh(make_tetrahedron()), shape_from_mesh(make_box({1, 0.5, 0.3}))}) {
    const MeshResult result = meshed(shape, {.vertices = 1000});
    expect_good_mesh(result);
    const double volume = measure_quality(*shape.mesh()).volume;
    EXPECT_NEAR(result.report.quality.volume, volume, 1e-4 * volume);
    EXPECT_LT(farthest_crease(result.mesh, *shape.mesh()), 0.01);
  }
}

TEST(Features, BooleanEdgesAreKept) {
  const Box bounds{{-1.2, -1.2, -1.2}, {1.2, 1.2, 1.2}};
  const Shape cup =
      shape_from_expression("max(x^2 + y^2 - 1, abs(z) - 1, -max(x^2 + y^2 - 0.5, -0.5 - z))", {}, bounds);
  const MeshResult result = meshed(cup, {.vertices = 3000});
  expect_good_mesh(result);
  EXPECT_EQ(result.report.quality.euler, 2);
  const double volume = std::numbers::pi * (2 - 0.5 * 1.5);
  EXPECT_NEAR(result.report.quality.volume, volume, 5e-3 * volume);
  // Four circles: the base, the rim outside and inside, the inner floor.
  EXPECT_NEAR(result.report.crease_length, 2 * std::numbers::pi * (2 + 2 * std::sqrt(0.5)), 0.05);
}

/// Distance from a point to the nearest edge of the mesh.
double from_edges(const Mesh& mesh, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 a = mesh.vertices[t[c]], along = mesh.vertices[t[(c + 1) % 3]] - a;
      const double share = std::clamp(dot(p - a, along) / squared_norm(along), 0.0, 1.0);
      nearest = std::min(nearest, norm(p - a - share * along));
    }
  return nearest;
}

TEST(Features, EdgesFollowTightCirclesWithinATenthOfTheirLength) {
  const Shape ring = shape_from_expression("max(x^2 + y^2 - 1, 0.16 - x^2 - y^2, abs(z) - 0.5)", {},
                                           Box{{-1.1, -1.1, -0.6}, {1.1, 1.1, 0.6}});
  for (const std::size_t vertices : {150u, 250u, 400u, 700u}) {
    const MeshResult result = meshed(ring, {.vertices = vertices});
    expect_good_mesh(result);
    double farthest = 0;
    for (const double radius : {0.4, 1.0})
      for (int degree = 0; degree < 360; degree += 3) {
        const double angle = degree * std::numbers::pi / 180;
        for (const double z : {-0.5, 0.5})
          farthest =
              std::max(farthest, from_edges(result.mesh, {radius * std::cos(angle), radius * std::sin(angle), z}));
      }
    EXPECT_LT(farthest, 0.1 * result.report.quality.edge_length_avg) << vertices;
  }
}

TEST(Features, TipsOfConesHaveAVertex) {
  // Two cones, base to base.
  const Shape cones =
      shape_from_expression("sqrt(x^2 + y^2) - 0.7 * (1 - abs(z))", {}, Box{{-1, -1, -1.1}, {1, 1, 1.1}});
  for (const std::size_t vertices : {300u, 2000u}) {
    const MeshResult result = meshed(cones, {.vertices = vertices});
    expect_good_mesh(result);
    expect_count(result, vertices);
    for (const Vec3& apex : {Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
      double nearest = 1;
      for (const Vec3& v : result.mesh.vertices) nearest = std::min(nearest, norm(v - apex));
      EXPECT_LT(nearest, 0.01 * result.report.quality.edge_length_avg) << vertices;
    }
  }
}

TEST(Features, OfABoxStayWhereItsKnobsAreTooSmall) {
  // 64 knobs, each of them smaller than an edge.
  const Shape shape = shape_from_expression(
      "min(max(max(abs(x) - 1, abs(y) - 1), abs(z) - 0.5), max(max(max(abs(mod(x, 0.2) - 0.1) - 0.05, abs(mod(y, 0.2) "
      "- "
      "0.1) - 0.05), max(abs(x), abs(y)) - 0.8), abs(z - 0.5) - 0.1))",
      {}, Box{{-1.1, -1.1, -0.7}, {1.1, 1.1, 0.7}});
  const MeshResult result = meshed(shape, {.vertices = 1000});
  expect_good_mesh(result);
  EXPECT_NEAR(result.report.crease_length, 8 * 2 + 4 * 1, 1e-3);
  const auto said = std::find_if(result.report.findings.begin(), result.report.findings.end(),
                                 [](const Finding& f) { return f.code == FindingCode::features_not_followed; });
  ASSERT_NE(said, result.report.findings.end());
  EXPECT_EQ(said->values[0], (std::pair<std::string, FindingValue>("count", 64 * 12.0)));
  ASSERT_TRUE(said->place);
  EXPECT_LT(std::max(std::abs(said->place->x), std::abs(said->place->y)), 0.85) << "on a knob";
}

/// A ball whose facets stand at random angles, as scans have them.
Mesh rough_ball() {
  Mesh ball = make_icosphere(4);
  Random random(5);
  for (Vec3& v : ball.vertices) v = v * (1 + 0.008 * random.gaussian());
  return ball;
}

TEST(Features, NoiseIsNone) {
  for (const std::size_t vertices : {3000u, 12000u})
    EXPECT_EQ(meshed(shape_from_mesh(rough_ball()), {.vertices = vertices}).report.crease_vertices, 0u) << vertices;
}

TEST(Features, AreFoundBesideNoise) {
  const Shape cut = subtract(shape_from_mesh(rough_ball()), {shape_from_box({{-2, -2, 0.3}, {2, 2, 2}})});
  const double rim = 2 * std::numbers::pi * std::sqrt(1 - 0.3 * 0.3);
  EXPECT_NEAR(meshed(cut, {.vertices = 3000}).report.crease_length, rim, 0.1 * rim);
}

TEST(Features, SmoothShapesDoNotChange) {
  for (const char* name : {"torus", "rounded-box", "tangle"}) {
    const MeshOptions off{.vertices = 700, .feature_angle = std::nullopt}, on{.vertices = 700};
    EXPECT_TRUE(same_mesh(meshed(gallery_shape(name), off).mesh, meshed(gallery_shape(name), on).mesh)) << name;
  }
}

TEST(Features, TheAngleDecides) {
  // A prism whose edges turn by 60°.
  const Shape prism = shape_from_expression("max(abs(x), abs(x) / 2 + abs(y) * sqrt(3) / 2, abs(z)) - 1", {},
                                            Box{{-1.3, -1.3, -1.3}, {1.3, 1.3, 1.3}});
  const double top = 2 * 6 * 2 / std::sqrt(3.0), sides = 6 * 2;
  EXPECT_NEAR(meshed(prism, {.vertices = 800, .feature_angle = 40}).report.crease_length, top + sides, 0.05);
  EXPECT_NEAR(meshed(prism, {.vertices = 800, .feature_angle = 75}).report.crease_length, top, 0.1);
  EXPECT_EQ(meshed(prism, {.vertices = 800, .feature_angle = 100}).report.crease_length, 0);
}

TEST(Features, SameBytesForAnyNumberOfThreads) {
  const Shape shape = gallery_shape("schwarz-p");
  const MeshResult one = meshed(shape, {.vertices = 2000}, 1);
  EXPECT_GT(one.report.crease_vertices, 0u);
  for (const unsigned threads : {2u, 7u})
    EXPECT_TRUE(same_mesh(one.mesh, meshed(shape, {.vertices = 2000}, threads).mesh));
}

TEST(Features, WrongAnglesAreRefused) {
  for (const double angle : {0.0, -5.0, 180.0, std::nan("")})
    EXPECT_THROW(meshed(gallery_shape("cube"), {.vertices = 100, .feature_angle = angle}), InvalidInput);
}

}  // namespace
}  // namespace evenmesh
