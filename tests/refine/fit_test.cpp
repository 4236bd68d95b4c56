#include "refine/fit.h"

#include "geometry/closest_point.h"
#include "refine/refine_testing.h"

namespace evenmesh {
namespace {

double largest_deviation(const CellMesh& cells, const Mesh& mesh) {
  const SurfaceQuery surface(mesh);
  double largest = 0;
  for (const SampleBlock& block : cells.samples.blocks)
    for (std::size_t i = block.begin; i < block.end; ++i)
      largest = std::max(largest, surface
                                      .closest(cells.samples.block_center(block) +
                                               Vec3{cells.samples.x[i], cells.samples.y[i], cells.samples.z[i]})
                                      .squared_distance);
  return std::sqrt(largest);
}

double edge_length(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) sum += norm(mesh.vertices[t[(c + 1) % 3]] - mesh.vertices[t[c]]);
  return sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

struct Pointed {
  const char *name, *expression;
  friend void PrintTo(const Pointed& p, std::ostream* out) { *out << p.name; }
};

class FitExtremes : public testing::TestWithParam<Pointed> {};

TEST_P(FitExtremes, LowersTheLargestDeviation) {
  evenmesh::ExecutionContext context(2);
  const Shape shape = shape_from_expression(GetParam().expression, {}, {{-1.2, -1.2, -1.2}, {1.2, 1.2, 1.7}});
  const auto projector = make_projector(shape, shape.bounds, context);
  CellMesh cells = mesh_of_cells(shape, 80, 400);
  expect_closed_manifold(cells.mesh);
  Mesh fitted = cells.mesh;
  const double worst = worst_score(fitted);
  const FitResult result = fit_extremes(fitted, cells.samples, cells.labels, projector.get(), {}, context);
  EXPECT_GT(result.moves, 0u);
  EXPECT_LE(result.moves, result.attempts);
  EXPECT_LE(result.flips, result.moves);
  EXPECT_LT(result.deviation, result.deviation_before);
  expect_closed_manifold(fitted);
  EXPECT_EQ(fitted.vertices.size(), cells.mesh.vertices.size());
  EXPECT_EQ(edge_count(fitted), edge_count(cells.mesh)) << "the Euler number stays";
  EXPECT_LT(largest_deviation(cells, fitted), 0.9 * largest_deviation(cells, cells.mesh));
  EXPECT_LE(largest_deviation(cells, fitted), std::max(result.deviation, 0.15 * edge_length(fitted)));
  EXPECT_GE(worst_score(fitted), std::min(worst, 1.0) - 1e-9) << "triangles stay good";
}

TEST_P(FitExtremes, FindsTheNearestVertexFromOneBesideIt) {
  evenmesh::ExecutionContext context(2);
  const Shape shape = shape_from_expression(GetParam().expression, {}, {{-1.2, -1.2, -1.2}, {1.2, 1.2, 1.7}});
  const auto projector = make_projector(shape, shape.bounds, context);
  const CellMesh cells = mesh_of_cells(shape, 60, 300);
  const VertexRings rings(cells.mesh);
  std::vector<std::uint32_t> beside = cells.labels;
  for (std::size_t i = 0; i < beside.size(); i += 2) beside[i] = rings.neighbours(beside[i])[0];
  Mesh expected = cells.mesh, fitted = cells.mesh;
  fit_extremes(expected, cells.samples, cells.labels, projector.get(), {}, context);
  fit_extremes(fitted, cells.samples, beside, projector.get(), {}, context);
  EXPECT_EQ(fitted.vertices, expected.vertices);
  EXPECT_EQ(fitted.triangles, expected.triangles);
}

INSTANTIATE_TEST_SUITE_P(Shapes, FitExtremes,
                         testing::Values(Pointed{"cone", "max(sqrt(x^2+y^2) - 0.5(1.4 - z), -0.6 - z)"},
                                         Pointed{"spike", "min(r - 0.8, max(sqrt(x^2+y^2) - 0.5(1.5 - z), -z))"},
                                         Pointed{"lens", "max(sqrt(x^2+y^2+(z-0.6)^2), sqrt(x^2+y^2+(z+0.6)^2)) - 1"}),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(FitSmooth, LeavesSmoothSurfacesAlone) {
  evenmesh::ExecutionContext context(1);
  const Shape shape = gallery_shape("sphere");
  const auto projector = make_projector(shape, shape.bounds, context);
  CellMesh cells = mesh_of_cells(shape, 60, 300);
  for (Vec3& v : cells.mesh.vertices) v = projector->project(v, 0.1);
  const auto vertices = cells.mesh.vertices;
  const FitResult result = fit_extremes(cells.mesh, cells.samples, cells.labels, projector.get(), {}, context);
  EXPECT_EQ(result.attempts, 0u);
  EXPECT_EQ(result.deviation, 0);
  EXPECT_EQ(cells.mesh.vertices, vertices);
}

/// Where a triangle spans a hollow every sample is near the mesh, and only the mesh is far from the surface.
TEST(FitSmooth, BringsBackTrianglesThatLeaveTheSurface) {
  evenmesh::ExecutionContext context(2);
  const Shape shape = gallery_shape("sphere");
  const auto projector = make_projector(shape, shape.bounds, context);
  CellMesh cells = mesh_of_cells(shape, 60, 300);
  for (Vec3& v : cells.mesh.vertices) v = projector->project(v, 0.1);
  const double edge = edge_length(cells.mesh);
  cells.mesh.vertices[7] += 0.5 * edge * normalized(cells.mesh.vertices[7]);
  const double floor = std::min(1.0, worst_score(cells.mesh));
  // Without the vertex' own samples.
  for (std::uint32_t& label : cells.labels)
    if (label == 7) label = 0xffffffffu;
  const FitResult result = fit_extremes(cells.mesh, cells.samples, cells.labels, projector.get(), {}, context);
  EXPECT_GT(result.deviation_before, 0.4 * edge);
  EXPECT_LT(result.deviation, 0.3 * edge);
  EXPECT_GE(worst_score(cells.mesh), floor - 1e-9);
}

TEST(FitSmooth, KeepsGoodAnglesOnDomesThatAreTooSmall) {
  evenmesh::ExecutionContext context(2);
  // A plate with pins of a radius below the edge length.
  const Shape shape = shape_from_expression(
      "min(max(max(abs(x), abs(y)) - 1, abs(z) - 0.3), min(sqrt((x-0.3)^2+y^2+(z-0.35)^2), "
      "sqrt((x+0.4)^2+(y-0.3)^2+(z-0.33)^2)) - 0.12)",
      {}, {{-1.2, -1.2, -0.6}, {1.2, 1.2, 0.7}});
  const auto projector = make_projector(shape, shape.bounds, context);
  CellMesh cells = mesh_of_cells(shape, 80, 400);
  for (Vec3& v : cells.mesh.vertices) v = projector->project(v, 0.1);
  const double before = worst_score(cells.mesh);
  const FitResult result = fit_extremes(cells.mesh, cells.samples, cells.labels, projector.get(), {}, context);
  EXPECT_LT(result.deviation, result.deviation_before);
  EXPECT_GE(worst_score(cells.mesh), std::min(before, 1.0) - 1e-9);
  expect_closed_manifold(cells.mesh);
}

TEST(FitSmooth, SamplesOfDustAreLeftOut) {
  evenmesh::ExecutionContext context(1);
  CellMesh cells = mesh_of_cells(gallery_shape("sphere"), 40, 100);
  std::fill(cells.labels.begin(), cells.labels.end(), 0xffffffffu);
  EXPECT_EQ(fit_extremes(cells.mesh, cells.samples, cells.labels, nullptr, {}, context).attempts, 0u);
}

}  // namespace
}  // namespace evenmesh
