#include "refine/placement.h"

#include "refine/refine_testing.h"

namespace evenmesh {
namespace {

SampleSet sampled_box() {
  evenmesh::ExecutionContext context(1);
  const Shape shape = shape_from_mesh(make_box({1, 1, 1}));
  return sample_shape(shape, make_grid(shape.bounds, 60), context);
}

/// Label 1 for the samples within `radius` of `center`, 0 for the others.
std::vector<std::uint32_t> patch(const SampleSet& samples, const Vec3& center, double radius) {
  std::vector<std::uint32_t> labels(samples.size());
  for (const SampleBlock& block : samples.blocks)
    for (std::size_t i = block.begin; i < block.end; ++i)
      labels[i] = norm(samples.block_center(block) + Vec3{samples.x[i], samples.y[i], samples.z[i]} - center) < radius;
  return labels;
}

TEST(Placement, ACellAroundACornerGoesTowardsIt) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled_box();
  const Vec3 corner{1, -1, 1};
  const auto shapes = cell_shapes(samples, patch(samples, corner, 0.3), std::vector<Vec3>{{0, 0, 0}, corner}, context);
  EXPECT_LT(norm(shapes[1].vertex - corner), 0.7 * norm(shapes[1].centroid - corner));
  EXPECT_NEAR(shapes[1].area, 3 * std::numbers::pi * 0.09 / 4, 0.01);
}

TEST(Placement, ACellAcrossAnEdgeGoesTowardsIt) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled_box();
  const auto shapes =
      cell_shapes(samples, patch(samples, {1, 1, 0}, 0.3), std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}}, context);
  const auto from_edge = [](const Vec3& p) { return std::hypot(p.x - 1, p.y - 1); };
  EXPECT_LT(from_edge(shapes[1].vertex), 0.8 * from_edge(shapes[1].centroid));
  EXPECT_NEAR(shapes[1].vertex.z, shapes[1].centroid.z, 1e-3);
}

TEST(Placement, AFlatCellStaysAtItsCentroid) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled_box();
  const auto shapes =
      cell_shapes(samples, patch(samples, {0.1, 0.2, 1}, 0.3), std::vector<Vec3>{{0, 0, 0}, {0.1, 0.2, 1}}, context);
  EXPECT_LT(norm(shapes[1].centroid - Vec3{0.1, 0.2, 1}), 0.005);
  EXPECT_LT(norm(shapes[1].vertex - shapes[1].centroid), 1e-4);
}

TEST(Placement, CurvedCellsComeBackTowardsTheSurface) {
  evenmesh::ExecutionContext context(1);
  const CellMesh cells = mesh_of_cells(gallery_shape("sphere"), 60, 60);
  double centroids = 0, vertices = 0;
  for (const CellShape& shape : cell_shapes(cells.samples, cells.labels, cells.mesh.vertices, context)) {
    EXPECT_GT(shape.area, 0);
    centroids += std::abs(norm(shape.centroid) - 1), vertices += std::abs(norm(shape.vertex) - 1);
  }
  EXPECT_LT(vertices, 0.8 * centroids);
}

TEST(Placement, LabelsWithoutSamplesKeepTheirSeed) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled_box();
  const std::vector<std::uint32_t> labels(samples.size(), 0);
  const auto shapes = cell_shapes(samples, labels, std::vector<Vec3>{{0, 0, 0}, {7, 8, 9}}, context);
  EXPECT_EQ(shapes[1].area, 0);
  EXPECT_EQ(shapes[1].vertex, (Vec3{7, 8, 9}));
  EXPECT_NEAR(shapes[0].area, samples.total_area, 1e-6 * samples.total_area);
}

TEST(Placement, SameBitsForAnyNumberOfThreads) {
  const CellMesh cells = mesh_of_cells(gallery_shape("torus"), 60, 200);
  evenmesh::ExecutionContext one(1), two(2);
  const auto place = [&](evenmesh::ExecutionContext& context) {
    return with_threads(context,
                        [&] { return cell_shapes(cells.samples, cells.labels, cells.mesh.vertices, context); });
  };
  const auto a = place(one), b = place(two);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].vertex, b[i].vertex);
    EXPECT_EQ(a[i].centroid, b[i].centroid);
    EXPECT_EQ(a[i].area, b[i].area);
  }
}

}  // namespace
}  // namespace evenmesh
