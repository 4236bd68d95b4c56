// Fields that want large batches and know little.

#include <gtest/gtest.h>

#include "evenmesh/solid.h"
#include "sample_checks.h"
#include "shape/affine_field.h"
#include "shape/remote_field.h"
#include "test_fields.h"

namespace evenmesh {
namespace {

using testing::RemoteField;

std::shared_ptr<const Field> field_of(const Shape& shape) {
  return std::get<std::shared_ptr<const Field>>(shape.what);
}

struct Remote {
  std::shared_ptr<const RemoteField> field;
  Shape shape;
};
Remote remote(const Shape& shape, double slope = 0) {
  const auto field = std::make_shared<const RemoteField>(field_of(shape), slope);
  return {field, {shape.name, shape.bounds, field, shape.capped_by_bounds}};
}

SampleSet sampled(const Shape& shape, std::size_t resolution, unsigned threads = 2) {
  evenmesh::Run run(threads);
  return sample_shape(shape, make_grid(shape.bounds, resolution), run);
}

double points_of(const Grid& grid) {
  return double(grid.size[0]) * grid.size[1] * grid.size[2];
}
double nodes_of(const Grid& grid) {
  double count = 1;
  for (const std::uint32_t n : grid.size) count *= (n + 63) / 64;
  return count;
}

TEST(RemoteField, SamplesAreTheSameAndCallsFew) {
  for (const char* name : {"torus", "octic", "barth", "gyroid", "menger-2", "cube", "julia"}) {
    const Shape shape = gallery_shape(name);
    const Remote far = remote(shape);
    const SampleSet set = sampled(far.shape, 128);
    expect_same(set, sampled(shape, 128));
    EXPECT_LE(double(far.field->calls), 60 * nodes_of(set.grid)) << name;
    EXPECT_EQ(far.field->single_points, 0u) << name;
    // Smooth fields take three for each root, those with kinks, and where f is 0 at the first guess, up to twenty.
    const double of_roots = 20.0 * double(set.size());
    EXPECT_LE(double(far.field->asked), 1.06 * points_of(set.grid) + of_roots) << name;
  }
}

TEST(RemoteField, HardlyMorePointsThanTheGridHas) {
  const Remote far = remote(gallery_shape("sphere"));
  const SampleSet set = sampled(far.shape, 160);
  EXPECT_LE(double(far.field->asked), 1.15 * points_of(set.grid));
  EXPECT_LE(far.field->calls, 300u);
}

TEST(RemoteField, AlikeForAnyNumberOfThreads) {
  const Remote far = remote(gallery_shape("octic"), 0);
  expect_same(sampled(far.shape, 150, 1), sampled(far.shape, 150, 2));
}

TEST(RemoteField, BoundsCutItAsOthers) {
  Shape shape = shape_from_expression("x^2+y^2-0.25+0.1*sin(5z)", {}, {{-1, -1, -0.7}, {1, 1, 0.83}});
  expect_same(sampled(remote(shape).shape, 100), sampled(shape, 100));
  EXPECT_TRUE(sampled(remote(shape).shape, 100).cut_by_bounds);
  // Bounds much smaller than the grid, as for operands of a boolean.
  const Grid grid = make_grid({{-3, -3, -3}, {3, 3, 3}}, 200);
  shape.bounds = {{-0.31, -0.4, -0.2}, {0.9, 0.37, 0.11}};
  const Remote far = remote(shape);
  expect_same(sample_shape(far.shape, grid), sample_shape(shape, grid));
  EXPECT_LE(double(far.field->asked), 0.1 * points_of(grid));
}

TEST(RemoteField, IndicatorsAsWell) {
  const auto f = [](double x, double y, double z) { return x * x + 2 * y * y + 3 * z * z < 1 ? -1.0 : 1.0; };
  const Shape shape = field_shape(f, {{-1.1, -0.8, -0.7}, {1.1, 0.8, 0.7}}, false);
  const Remote far = remote(shape);
  expect_same(sampled(far.shape, 90), sampled(shape, 90));
  EXPECT_LE(far.field->calls, 100u);
}

TEST(RemoteField, ABoundOnTheSlopePrunes) {
  const Shape shape =
      shape_from_expression("sqrt((sqrt(x^2+y^2)-1)^2+z^2)-0.35", {}, {{-1.4, -1.4, -0.4}, {1.4, 1.4, 0.4}});
  const Remote far = remote(shape, 1.0001);
  const SampleSet set = sampled(far.shape, 256);
  expect_same(set, sampled(shape, 256));
  EXPECT_LE(double(far.field->asked), 16.0 * double(set.size()));
  EXPECT_LE(double(far.field->asked), 0.5 * points_of(set.grid));
  EXPECT_LE(double(far.field->calls), 60 * nodes_of(set.grid));
}

TEST(RemoteField, ABoundThatIsTooLowTearsNothing) {
  const Shape shape =
      shape_from_expression("sqrt((sqrt(x^2+y^2)-1)^2+z^2)-0.35", {}, {{-1.4, -1.4, -0.4}, {1.4, 1.4, 0.4}});
  expect_same(sampled(remote(shape, 0.55).shape, 256), sampled(shape, 256));
}

TEST(RemoteField, FineGridsAreSketchedFirst) {
  for (const char* name : {"torus", "heart"}) {
    const Shape shape = gallery_shape(name);
    const Remote far = remote(shape);
    const SampleSet set = sampled(far.shape, 700);
    expect_same(set, sampled(shape, 700));
    EXPECT_LE(double(far.field->asked), 0.1 * points_of(set.grid) + 30.0 * double(set.size())) << name;
  }
}

TEST(RemoteField, StaysOneWhereItIsMoved) {
  const Shape shape = transformed(gallery_shape("torus"), Affine::rotate({1, 2, 3}, 40));
  const Remote far = remote(gallery_shape("torus"));
  Shape moved = transformed(far.shape, Affine::rotate({1, 2, 3}, 40));
  expect_same(sampled(moved, 100), sampled(shape, 100));
  EXPECT_EQ(moved.field()->batch_size(), far.field->batch_size());
  EXPECT_LE(double(far.field->calls), 300);
  const auto boxed = boxed_field(far.field, {{-1, -1, 0}, {1, 1, 1}});
  EXPECT_EQ(boxed->batch_size(), far.field->batch_size());
  const Box boxes[2] = {{{2, 2, 2}, {3, 3, 3}}, {{0, 0, 0}, {0.5, 0.5, 0.5}}};
  Interval ranges[2];
  boxed->enclose(boxes, ranges);
  EXPECT_EQ(ranges[0].lo, 2 - 1);
  EXPECT_EQ(ranges[1].hi, std::numeric_limits<double>::infinity());
}

TEST(RemoteField, ABoxAroundItIsNoInterval) {
  Shape shape = shape_from_expression("x^2+y^2-0.5", {}, {{-1, -1, -1}, {1, 1, 1}});
  const Remote far = remote(shape);
  const Affine turn = Affine::rotate({0, 0, 1}, 30);
  const SampleSet set = sampled(transformed(far.shape, turn), 100);
  expect_same(set, sampled(transformed(shape, turn), 100));
  EXPECT_LE(double(far.field->asked), 1.06 * points_of(set.grid) + 20.0 * double(set.size()));
}

}  // namespace
}  // namespace evenmesh
