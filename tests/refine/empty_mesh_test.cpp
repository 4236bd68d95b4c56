#include "refine/fit.h"
#include "refine/flips.h"
#include "refine/placement.h"
#include "refine/polish.h"
#include "refine/refine_testing.h"
#include "refine/untangle.h"

namespace evenmesh {
namespace {

/// No vertices, or vertices and no triangles.
class MeshWithoutTriangles : public testing::TestWithParam<std::size_t> {
 protected:
  Mesh mesh_{std::vector<Vec3>(GetParam(), Vec3{0.1, 0.2, 0.3}), {}};
  ExecutionContext context_{2};

  void expect_unchanged() const {
    EXPECT_EQ(mesh_.vertices, std::vector<Vec3>(GetParam(), Vec3{0.1, 0.2, 0.3}));
    EXPECT_TRUE(mesh_.triangles.empty());
  }
};

TEST_P(MeshWithoutTriangles, IsLeftAloneByRefinement) {
  const Shape shape = gallery_shape("sphere");
  const auto projector = make_projector(shape, shape.bounds, context_);
  const auto nothing = [](const Mesh&) { return std::vector<std::pair<std::uint32_t, std::uint32_t>>{}; };
  VertexConstraints constrained;
  constrained.curve.assign(GetParam(), VertexConstraints::corner);
  for (const VertexConstraints& constraints : {VertexConstraints{}, constrained}) {
    EXPECT_EQ(flip_to_delaunay(mesh_, constraints, context_), 0u);
    EXPECT_EQ(polish(mesh_, projector.get(), context_, constraints), 0u);
    EXPECT_EQ(untangle(mesh_, projector.get(), nothing, context_, constraints), 0u);
    expect_unchanged();
  }
  EXPECT_TRUE(triangles_below(mesh_, 1).empty());
  const VertexRings rings(mesh_);
  for (std::uint32_t v = 0; v < GetParam(); ++v) {
    EXPECT_TRUE(rings.triangles(v).empty());
    EXPECT_TRUE(rings.neighbours(v).empty());
  }
}

TEST_P(MeshWithoutTriangles, IsNotFitted) {
  const Shape shape = gallery_shape("sphere");
  const SampleSet samples = sample_shape(shape, make_grid(shape.bounds, 30), context_);
  for (const std::uint32_t label : {0u, 0xffffffffu}) {
    const std::vector<std::uint32_t> labels(samples.size(), label);
    for (const double error : {0.0, 0.01})
      EXPECT_EQ(fit_extremes(mesh_, samples, labels, nullptr, {.sample_error = error}, context_).attempts, 0u);
  }
  EXPECT_EQ(fit_extremes(mesh_, {}, {}, nullptr, {}, context_).attempts, 0u);
  expect_unchanged();
}

INSTANTIATE_TEST_SUITE_P(Vertices, MeshWithoutTriangles, testing::Values(0u, 1u, 7u));

TEST(CellShapes, OfNothingAreTheSeeds) {
  ExecutionContext context(2);
  EXPECT_TRUE(cell_shapes({}, {}, {}, context).empty());
  const std::vector<Vec3> seeds{{1, 2, 3}};
  EXPECT_EQ(cell_shapes({}, {}, seeds, context).at(0).vertex, seeds[0]);
}

TEST(FitExtremes, AVertexWithoutTrianglesIsNobodysConcern) {
  ExecutionContext context(2);
  CellMesh cells = mesh_of_cells(gallery_shape("cube"), 40, 100);
  Mesh lonely = cells.mesh;
  lonely.vertices.push_back({5, 5, 5});
  std::vector<std::uint32_t> labels = cells.labels;
  labels[0] = static_cast<std::uint32_t>(cells.mesh.vertices.size());
  cells.labels[0] = 0xffffffffu;
  EXPECT_EQ(fit_extremes(lonely, cells.samples, labels, nullptr, {}, context).moves,
            fit_extremes(cells.mesh, cells.samples, cells.labels, nullptr, {}, context).moves);
  EXPECT_EQ(lonely.vertices.back(), (Vec3{5, 5, 5}));
}

}  // namespace
}  // namespace evenmesh
