#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "core/random.h"
#include "evenmesh/measure.h"
#include "geometry/primitives.h"

namespace evenmesh {
namespace {

/// Two unit cubes that touch along the vertical edge x = y = 1, sharing its two vertices.
Mesh two_cubes_sharing_an_edge() {
  Box low, high;
  low.add({0, 0, 0}), low.add({1, 1, 1});
  high.add({1, 1, 0}), high.add({2, 2, 1});
  Mesh mesh = merged(make_box_around(low), make_box_around(high));
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t)
      for (std::uint32_t w = 0; w < v; ++w)
        if (mesh.vertices[w] == mesh.vertices[v]) v = w;
  return mesh;
}

TEST(Quality, OfEquilateralTrianglesIsOne) {
  const MeshQuality q = measure_quality(make_tetrahedron());
  EXPECT_NEAR(q.q_min, 1, 1e-12);
  EXPECT_NEAR(q.q_avg, 1, 1e-12);
  EXPECT_NEAR(q.theta_min, 60, 1e-12);
  EXPECT_NEAR(q.theta_max, 60, 1e-12);
  EXPECT_NEAR(q.edge_length_cv, 0, 1e-6);
  EXPECT_EQ(q.below_30_ratio, 0);
}

TEST(Quality, OfAHalfSquare) {
  const MeshQuality q = measure_quality(make_grid_plane(4, 3, 2.0));
  // Legs 2, hypotenuse √8, area 2.
  EXPECT_NEAR(q.q_min, 12 / (std::sqrt(3.0) * (2 + std::sqrt(2.0)) * std::sqrt(8.0)), 1e-12);
  EXPECT_NEAR(q.q_avg, q.q_min, 1e-12);
  EXPECT_NEAR(q.theta_avg, 45, 1e-12);
  EXPECT_NEAR(q.theta_max, 90, 1e-12);
  EXPECT_NEAR(q.area, 48, 1e-12);
  EXPECT_EQ(q.boundary_edges, 14u);
  EXPECT_FALSE(q.closed());
  EXPECT_TRUE(q.two_manifold());
  EXPECT_EQ(q.euler, 1);
  EXPECT_EQ(q.irregular_ratio, 0);
}

TEST(Quality, KnowsTheTopologyOfClosedSurfaces) {
  const struct {
    Mesh mesh;
    int euler;
    std::size_t components;
  } cases[] = {{make_tetrahedron(), 2, 1},
               {make_icosphere(3), 2, 1},
               {make_torus(), 0, 1},
               {make_box(), 2, 1},
               {merged(make_torus(), translated(make_icosphere(2), {5, 0, 0})), 2, 2}};
  for (const auto& [mesh, euler, components] : cases) {
    const MeshQuality q = measure_quality(mesh);
    EXPECT_TRUE(q.closed());
    EXPECT_TRUE(q.two_manifold());
    EXPECT_TRUE(q.oriented());
    EXPECT_EQ(q.euler, euler);
    EXPECT_EQ(q.components, components);
    EXPECT_EQ(q.degenerate_faces, 0u);
    EXPECT_EQ(q.unused_vertices, 0u);
    EXPECT_GT(q.volume, 0);
  }
}

TEST(Quality, MeasuresAreaAndVolumeAnywhere) {
  const Vec3 away{1e4, -2e4, 3e3};
  const MeshQuality q = measure_quality(translated(make_box({1, 2, 3}, 4), away));
  EXPECT_NEAR(q.area, 88, 1e-8);
  EXPECT_NEAR(q.volume, 48, 1e-8);
  const MeshQuality torus = measure_quality(make_torus(1, 0.35, 300, 150));
  EXPECT_NEAR(torus.volume, 2 * std::numbers::pi * std::numbers::pi * 0.35 * 0.35, 5e-3);
  EXPECT_EQ(torus.irregular_ratio, 0);
  EXPECT_EQ(torus.max_valence, 6u);
}

TEST(Quality, IcosphereHasTwelveIrregularVertices) {
  const MeshQuality q = measure_quality(make_icosphere(3));
  EXPECT_NEAR(q.irregular_ratio * static_cast<double>(q.vertices), 12, 1e-9);
}

TEST(Quality, InsideOutHasNegativeVolume) {
  Mesh mesh = make_icosphere(2);
  const double volume = measure_quality(mesh).volume;
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(measure_quality(mesh).volume, -volume, 1e-12);
  EXPECT_TRUE(measure_quality(mesh).oriented());
}

TEST(Quality, FlippedTriangleDisagreesWithItsThreeNeighbours) {
  Mesh mesh = make_icosphere(2);
  std::swap(mesh.triangles[17][0], mesh.triangles[17][1]);
  const MeshQuality q = measure_quality(mesh);
  EXPECT_EQ(q.inconsistent_edges, 3u);
  EXPECT_TRUE(q.closed());
  EXPECT_TRUE(q.two_manifold());
}

TEST(Quality, FindsNonManifoldEdges) {
  const MeshQuality q = measure_quality(two_cubes_sharing_an_edge());
  EXPECT_EQ(q.non_manifold_edges, 1u);
  EXPECT_EQ(q.non_manifold_vertices, 2u);
  EXPECT_EQ(q.components, 1u);
  EXPECT_EQ(q.unused_vertices, 2u);
  EXPECT_EQ(q.boundary_edges, 0u);
}

TEST(Quality, FindsBowtieVertices) {
  Mesh mesh = merged(make_tetrahedron(), make_tetrahedron());
  for (std::size_t v = 4; v < 8; ++v) mesh.vertices[v] = 2 * mesh.vertices[0] - mesh.vertices[v];
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = v == 4 ? 0 : v;
  const MeshQuality q = measure_quality(mesh);
  EXPECT_EQ(q.non_manifold_vertices, 1u);
  EXPECT_EQ(q.non_manifold_edges, 0u);
  EXPECT_EQ(q.components, 2u);
  EXPECT_TRUE(q.closed());
}

TEST(Quality, OpeningASphereGivesABoundaryButNoBowtie) {
  Mesh mesh = make_icosphere(2);
  mesh.triangles.pop_back();
  const MeshQuality q = measure_quality(mesh);
  EXPECT_EQ(q.boundary_edges, 3u);
  EXPECT_EQ(q.euler, 1);
  EXPECT_TRUE(q.two_manifold());
}

TEST(Quality, CountsDegenerateTriangles) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {1, 0, 0}, {5, 3, 3 + 1e-12}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 3}, {0, 1, 3}, {0, 3, 3}, {3, 2, 4}};
  const MeshQuality q = measure_quality(mesh);
  EXPECT_EQ(q.degenerate_faces, 3u);
  EXPECT_EQ(q.q_min, 0);
  EXPECT_EQ(q.theta_min, 0);
}

TEST(Quality, OfNothingIsNothing) {
  Mesh mesh;
  mesh.vertices.resize(3);
  const MeshQuality q = measure_quality(mesh);
  EXPECT_EQ(q.faces, 0u);
  EXPECT_EQ(q.unused_vertices, 3u);
  EXPECT_FALSE(q.closed());
}

TEST(Quality, IsTheSameForAnyNumberOfThreads) {
  Mesh mesh = make_icosphere(5);
  Random random(3);
  for (Vec3& v : mesh.vertices) v *= 1 + 0.05 * random.uniform();
  evenmesh::ExecutionContext one(1), three(3);
  EXPECT_EQ(quality_json(measure_quality(mesh, one)), quality_json(measure_quality(mesh, three)));
}

TEST(Quality, IsTheSameForAnyOrderOfTheTriangles) {
  Mesh mesh = two_cubes_sharing_an_edge();
  const MeshQuality before = measure_quality(mesh);
  Random random(4);
  for (std::size_t i = mesh.triangles.size(); i > 1; --i)
    std::swap(mesh.triangles[i - 1], mesh.triangles[random.below(i)]);
  for (Triangle& t : mesh.triangles) t = {t[1], t[2], t[0]};
  const MeshQuality after = measure_quality(mesh);
  EXPECT_EQ(before.euler, after.euler);
  EXPECT_EQ(before.non_manifold_vertices, after.non_manifold_vertices);
  EXPECT_EQ(before.inconsistent_edges, after.inconsistent_edges);
  EXPECT_NEAR(before.volume, after.volume, 1e-12);
}

TEST(Quality, JsonHoldsTheDocumentedKeys) {
  const std::string json = quality_json(measure_quality(make_box()));
  for (const char* key : {"vertices", "faces", "q_min", "q_avg", "theta_min", "theta_avg", "irregular_ratio",
                          "boundary_edges", "non_manifold_edges", "non_manifold_vertices", "components", "euler",
                          "closed", "oriented", "area", "volume", "edge_length_avg"})
    EXPECT_NE(json.find('"' + std::string(key) + "\": "), std::string::npos) << key;
  EXPECT_NE(json.find("\"closed\": true"), std::string::npos);
  EXPECT_NE(json.find("\"faces\": 12,"), std::string::npos);
}

TEST(Histogram, CountsEveryAngleAndTriangleOnce) {
  const Mesh mesh = make_icosphere(3);
  const auto total = [](const Histogram& h) {
    return std::accumulate(h.counts.begin(), h.counts.end(), std::size_t{0});
  };
  const Histogram angles = histogram_of_angles(mesh, 36), quality = histogram_of_quality(mesh, 20);
  EXPECT_EQ(total(angles), 3 * mesh.triangles.size());
  EXPECT_EQ(total(quality), mesh.triangles.size());
  EXPECT_EQ(histogram_of_angles(make_grid_plane(2, 2), 18).counts[9], 8u);  // right angles begin the bin [90°, 100°)
  EXPECT_THROW(histogram_of_angles(mesh, 0), InvalidInput);
}

}  // namespace
}  // namespace evenmesh
