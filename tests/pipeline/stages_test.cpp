/// The steps of mesh_shape() by themselves, where a whole run does not come to what is tested.

#include <gtest/gtest.h>

#include "evenmesh/solid.h"
#include "pipeline/kernels.h"
#include "pipeline/pipeline_testing.h"
#include "pipeline/report.h"

namespace evenmesh {
namespace {

TEST(Stages, AMeshWithoutTrianglesIsRefusedBeforeItIsPlaced) {
  const Tessellation nothing;
  EXPECT_THROW(extract(nothing, {}, ExecutionContext::silent()), UnusableInput);
}

MeshResult measured(const Mesh& mesh, std::int64_t surface_euler, std::size_t two_triangle_spheres = 0) {
  Tessellation cells;
  cells.complex.surface_euler = surface_euler;
  cells.sampling.plan.vertices = mesh.vertices.size();
  Draft draft;
  draft.two_triangle_spheres = two_triangle_spheres;
  StageTimer timer(ExecutionContext::silent());
  return measure({mesh, 0}, draft, cells, {}, {}, timer, ExecutionContext::silent());
}

TEST(Stages, AnotherEulerNumberThanThatOfTheSurfaceIsSaid) {
  const Mesh ball = make_icosphere(2);
  EXPECT_TRUE(measured(ball, 2).report.findings.empty());
  EXPECT_TRUE(has_finding(measured(ball, 0).report, FindingCode::euler_differs));
  EXPECT_FALSE(has_finding(measured(ball, 4, 1).report, FindingCode::euler_differs)) << "a component was left out";
}

TEST(Stages, IntersectionsOfAMeshThatIsNotTwoManifoldAreCounted) {
  // Two tetrahedra that share an edge, and run through each other.
  Draft draft;
  draft.mesh.vertices = {{0, 0, 0}, {0, 0, 2}, {2, 0, 1}, {1, 2, 1}, {1.5, 0.1, 1.2}, {0.5, 2.5, 0.8}};
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    for (const Triangle& t : {Triangle{a, b, c}, Triangle{a, d, b}, Triangle{b, d, c}, Triangle{a, c, d}})
      draft.mesh.triangles.push_back(t);
  };
  add(0, 1, 2, 3);
  add(0, 1, 4, 5);
  ASSERT_FALSE(measure_quality(draft.mesh).two_manifold());
  const std::size_t pairs = self_intersections(draft.mesh).size();
  ASSERT_GT(pairs, 0u);
  StageTimer timer(ExecutionContext::silent());
  const auto sampler = make_sampler(shape_from_mesh(draft.mesh), {}, {}, timer, ExecutionContext::silent());
  const MeshOptions centroids{.placement = Placement::centroid};
  EXPECT_EQ(refine(draft, {}, *sampler, centroids, timer, ExecutionContext::silent()).self_intersections, pairs);
}

TEST(Stages, CrossingsThatTheGridCannotHoldAreCountedAndSaid) {
  // A sheaf of plates, each thinner than a third of a cell.
  Shape plates = shape_from_box({{-1, -1, -1}, {1, 1, 0}});
  for (int i = 0; i < 6; ++i) {
    const double x = -0.9 + 0.3 * i;
    plates = unite({plates, shape_from_mesh(make_box_around(Box{{x, -1, -0.5}, {x + 0.005, 1, 1}}))});
  }
  const Report report = meshed(plates, {.vertices = 1000, .resolution = 100}).report;
  EXPECT_GT(report.unresolved, 500u);
  EXPECT_TRUE(has_finding(report, FindingCode::thin_parts_lost));
  EXPECT_EQ(meshed(gallery_shape("cube"), {.vertices = 500}).report.unresolved, 0u);
}

/// Kernels that hand on to the CPU, and count.
struct Counting final : RayKernel, NarrowBandKernel, CellKernel, ExtractionKernel {
  SampleSet sample(const Shape& shape, const Grid& grid, ExecutionContext& context) const override {
    ++sampled;
    return sample_shape(shape, grid, context);
  }
  NarrowBand build(const SiteVoxels& sites, unsigned reach, ExecutionContext& context) const override {
    ++built;
    return build_narrow_band(sites, reach, context);
  }
  std::unique_ptr<CellEvaluator> evaluator(const SampleSet& samples, ExecutionContext& context) const override {
    ++evaluators;
    return std::make_unique<CpuCellEvaluator>(samples, context);
  }
  LabelComplex connect(const SampleSet& samples, std::vector<std::uint32_t>& labels, const Seeds& seeds,
                       ExecutionContext& context) const override {
    ++connected;
    return connect_labels(samples, labels, seeds, context);
  }
  mutable int sampled = 0, built = 0, evaluators = 0, connected = 0;
};

TEST(Stages, KernelsTakeOverWhatADeviceCanDo) {
  const Counting counting;
  const Kernels kernels{&counting, &counting, &counting, &counting};
  const Shape torus = gallery_shape("torus");
  for (const Method method : {Method::raster, Method::shell}) {
    const MeshOptions options{.vertices = 600, .method = method};
    Artifacts none;
    const MeshResult result = mesh_with(kernels, torus, options, ExecutionContext::silent(), none);
    EXPECT_TRUE(same_mesh(result.mesh, meshed(torus, options).mesh));
  }
  EXPECT_GT(counting.sampled, 0);
  EXPECT_GT(counting.built, 0);
  EXPECT_GT(counting.evaluators, 0);
  EXPECT_GT(counting.connected, 0);
}

TEST(Stages, SimplifyKeepsWhatIsFixed) {
  // A bore narrower than an edge has to go; the block around it keeps its corners and edges.
  const Shape block = shape_from_mesh(make_box_around(Box{{-1, -1, -1}, {1, 1, 1}}));
  const Shape bore = shape_from_expression("(x-0.1)^2 + (y+0.2)^2 - 0.002");
  const MeshResult result =
      meshed(subtract(block, {bore}), {.vertices = 700, .resolution = 160, .topology = TopologyRule::simplify});
  expect_good_mesh(result);
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p{corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0};
    double nearest = 1;
    for (const Vec3& v : result.mesh.vertices) nearest = std::min(nearest, norm(v - p));
    EXPECT_LT(nearest, 1e-3) << corner;
  }
}

}  // namespace
}  // namespace evenmesh
