#include "core/parallel.h"
#include "refine/fit.h"
#include "refine/flips.h"
#include "refine/polish.h"
#include "refine/refine_testing.h"

namespace evenmesh {
namespace {

/// Calls make() with 1, 2 and 7 threads, several times; all must return the same.
template <typename Make>
void expect_same_for_any_number_of_threads(const Make& make) {
  ExecutionContext one(1);
  const Mesh expected = with_threads(one, [&] { return make(one); });
  for (const unsigned threads : {1u, 2u, 7u, 2u, 7u}) {
    ExecutionContext context(threads);
    const Mesh mesh = with_threads(context, [&] { return make(context); });
    EXPECT_EQ(mesh.triangles, expected.triangles) << threads << " threads";
    EXPECT_EQ(mesh.vertices, expected.vertices) << threads << " threads";
  }
}

TEST(Threads, DoNotChangeFlips) {
  for (const double amplitude : {0.012, 0.02, 0.1})  // from few flips to many
    expect_same_for_any_number_of_threads([&](ExecutionContext& context) {
      Mesh mesh = perturbed_sphere(4, amplitude, 3);
      EXPECT_GT(flip_to_delaunay(mesh, {}, context), 0u);
      return mesh;
    });
}

TEST(Threads, DoNotChangePolish) {
  const Shape shape = gallery_shape("sphere");
  ExecutionContext any;
  const auto projector = make_projector(shape, shape.bounds, any);
  for (const double amplitude : {0.005, 0.01, 0.03})
    expect_same_for_any_number_of_threads([&](ExecutionContext& context) {
      Mesh mesh = perturbed_sphere(4, amplitude, 5);
      flip_to_delaunay(mesh, {}, context);
      EXPECT_GT(polish(mesh, projector.get(), context), 0u);
      return mesh;
    });
}

TEST(Threads, DoNotChangeFits) {
  const Shape shape =
      shape_from_expression("max(sqrt(x^2+y^2) - 0.5(1.4 - z), -0.6 - z)", {}, {{-1.2, -1.2, -1.2}, {1.2, 1.2, 1.7}});
  ExecutionContext any;
  const auto projector = make_projector(shape, shape.bounds, any);
  const CellMesh cells = mesh_of_cells(shape, 60, 300);
  expect_same_for_any_number_of_threads([&](ExecutionContext& context) {
    Mesh mesh = cells.mesh;
    EXPECT_GT(fit_extremes(mesh, cells.samples, cells.labels, projector.get(), {}, context).moves, 0u);
    return mesh;
  });
}

TEST(Rings, HoldTheTrianglesAndNeighboursOfEveryVertex) {
  const Mesh mesh = perturbed_sphere(5, 0.01, 1);
  for (const unsigned threads : {1u, 2u, 7u}) {
    ExecutionContext context(threads);
    with_threads(context, [&] {
      const VertexRings rings(mesh, context);
      std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size()), beside(mesh.vertices.size());
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t]) {
          around[v].push_back(t);
          for (const std::uint32_t w : mesh.triangles[t])
            if (w != v && std::find(beside[v].begin(), beside[v].end(), w) == beside[v].end()) beside[v].push_back(w);
        }
      for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
        EXPECT_TRUE(
            std::equal(around[v].begin(), around[v].end(), rings.triangles(v).begin(), rings.triangles(v).end()));
        EXPECT_TRUE(
            std::equal(beside[v].begin(), beside[v].end(), rings.neighbours(v).begin(), rings.neighbours(v).end()));
      }
    });
  }
}

}  // namespace
}  // namespace evenmesh
