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
  EXPECT_GT(fit_extremes(fitted, cells.samples, cells.labels, projector.get(), 0, context), 0u);
  expect_closed_manifold(fitted);
  EXPECT_LT(largest_deviation(cells, fitted), 0.9 * largest_deviation(cells, cells.mesh));
  EXPECT_GE(worst_score(fitted), std::min(worst, 0.92) - 1e-9) << "triangles stay good";
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
  EXPECT_EQ(fit_extremes(cells.mesh, cells.samples, cells.labels, projector.get(), 0, context), 0u);
  EXPECT_EQ(cells.mesh.vertices, vertices);
}

TEST(FitSmooth, SamplesOfDustAreLeftOut) {
  evenmesh::ExecutionContext context(1);
  CellMesh cells = mesh_of_cells(gallery_shape("sphere"), 40, 100);
  std::fill(cells.labels.begin(), cells.labels.end(), 0xffffffffu);
  EXPECT_EQ(fit_extremes(cells.mesh, cells.samples, cells.labels, nullptr, 0, context), 0u);
}

}  // namespace
}  // namespace evenmesh
