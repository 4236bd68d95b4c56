/// Fragments and the simplification of topology through the whole pipeline.

#include <numeric>

#include "pipeline/shell_testing.h"

namespace evenmesh {
namespace {

void expect_shares(const Report& report, std::size_t longest) {
  ASSERT_EQ(report.cycle_shares.size(), longest - 2);
  EXPECT_NEAR(std::accumulate(report.cycle_shares.begin(), report.cycle_shares.end(), 0.0), 1, 1e-12);
  EXPECT_GT(report.cycle_shares[0], 0.9);
}

TEST(Fragments, MeshSolids) {
  for (const char* name : {"sphere", "torus", "octic"}) {
    SCOPED_TRACE(name);
    const bool is_octic = std::string(name) == "octic";
    const MeshOptions options{
        .vertices = is_octic ? 2500u : 400u, .quality = Quality::fast, .connect = Connect::fragments};
    const MeshResult one = meshed(gallery_shape(name), options, 1), two = meshed(gallery_shape(name), options, 2);
    expect_good_mesh(one);
    expect_count(one, *options.vertices);
    expect_shares(one.report, 5);
    EXPECT_TRUE(same_mesh(one.mesh, two.mesh));
    MeshOptions by_complex = options;
    by_complex.connect = Connect::complex;
    const MeshResult reference = meshed(gallery_shape(name), by_complex);
    EXPECT_EQ(one.report.quality.euler, reference.report.quality.euler);
    EXPECT_TRUE(reference.report.cycle_shares.empty());
  }
}

TEST(Fragments, MeshOpenSheets) {
  MeshOptions options = by_shell(400);
  options.connect = Connect::fragments;
  options.max_cycle = 7;
  const MeshResult result = meshed(shape_from_mesh(hemisphere()), options);
  expect_good_sheet(result);
  expect_shares(result.report, 7);
  EXPECT_EQ(boundary_loops(result.mesh), 1u);
  EXPECT_EQ(result.report.quality.euler, 1);
  const MeshResult points = meshed(shape_from_points(ball_of_points(20000, true)),
                                   {.vertices = 300, .quality = Quality::fast, .connect = Connect::fragments});
  expect_good_sheet(points);
  EXPECT_EQ(points.report.quality.euler, 2);
}

TEST(Fragments, CyclesAreShorterThanNine) {
  for (const std::size_t cycle : {std::size_t{2}, std::size_t{9}})
    EXPECT_THROW(meshed(gallery_shape("sphere"), {.vertices = 100, .connect = Connect::fragments, .max_cycle = cycle}),
                 InvalidInput);
}

TEST(Fragments, WhatDoesNotFitTogetherIsSaid) {
  // Too coarse a grid for the sponge's tunnels.
  const MeshOptions options{.vertices = 120, .resolution = 30, .quality = Quality::fast, .connect = Connect::fragments};
  const MeshResult result = meshed(gallery_shape("menger-2"), options);
  const MeshQuality q = measure_quality(result.mesh);
  EXPECT_EQ(q.closed() && q.two_manifold() && q.oriented() && result.report.self_intersections == 0,
            !breaks_a_promise(result.report));
}

TEST(Fragments, SheetsHaveNoInsideToSimplify) {
  MeshOptions options = by_shell(200);
  options.connect = Connect::fragments;
  options.topology = TopologyRule::simplify;
  const MeshResult result = meshed(shape_from_mesh(hemisphere(4)), options);
  expect_good_sheet(result);
  EXPECT_TRUE(has_finding(result.report, FindingCode::sheet_topology_kept));
}

class Simplify : public testing::TestWithParam<Connect> {};

TEST_P(Simplify, KeepsTheNumberOfVertices) {
  const MeshOptions options{
      .vertices = 400, .quality = Quality::fast, .connect = GetParam(), .topology = TopologyRule::simplify};
  const Shape sponge = gallery_shape("menger-2");
  const MeshResult one = meshed(sponge, options, 1), two = meshed(sponge, options, 7);
  EXPECT_TRUE(same_mesh(one.mesh, two.mesh));
  const MeshQuality q = measure_quality(one.mesh);
  EXPECT_TRUE(q.closed() && q.two_manifold() && q.oriented());
  EXPECT_LE(one.mesh.vertices.size(), 402u);
  EXPECT_EQ(one.report.inserted_seeds, 0u);
  EXPECT_GT(one.report.regularization_rounds, 0u);
  EXPECT_TRUE(has_finding(one.report, FindingCode::topology_simplified));
}

TEST_P(Simplify, LeavesAloneWhatFitsTogether) {
  MeshOptions options{.vertices = 300, .quality = Quality::fast, .connect = GetParam()};
  const MeshResult keep = meshed(gallery_shape("torus"), options);
  options.topology = TopologyRule::simplify;
  const MeshResult simplified = meshed(gallery_shape("torus"), options);
  EXPECT_TRUE(same_mesh(keep.mesh, simplified.mesh));
  EXPECT_EQ(simplified.report.regularization_rounds, 0u);
}

INSTANTIATE_TEST_SUITE_P(Connections, Simplify, testing::Values(Connect::complex, Connect::fragments));

}  // namespace
}  // namespace evenmesh
