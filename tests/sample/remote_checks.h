#pragma once
/// Samples of fields that want large batches and know little, wherever they are evaluated.

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "evenmesh/solid.h"
#include "grid/sample_checks.h"
#include "shape/affine_field.h"
#include "shape/forms.h"
#include "shape/remote_field.h"

namespace evenmesh::testing {

struct Remote {
  std::shared_ptr<const RemoteField> field;
  Shape shape;
};

/// A shape on a device of a form, or as if on one.
inline Remote remote(const Form& form, const Shape& shape, double slope = 0) {
  const auto inner = std::get<std::shared_ptr<const Field>>(form(shape, slope).what);
  const auto field = std::make_shared<const RemoteField>(inner, slope);
  return {field, {shape.name, shape.bounds, field, shape.capped_by_bounds}};
}

inline double points_of(const Grid& grid) {
  return double(grid.size[0]) * grid.size[1] * grid.size[2];
}
inline double nodes_of(const Grid& grid) {
  double count = 1;
  for (const std::uint32_t n : grid.size) count *= (n + 63) / 64;
  return count;
}

class RemoteForms : public FormTest {
 protected:
  Remote remote(const Shape& shape, double slope = 0) const { return testing::remote(GetParam(), shape, slope); }
};

TEST_P(RemoteForms, SamplesAreTheSameAndCallsFew) {
  const bool expensive = GetParam().cost > 1;
  const std::size_t resolution = expensive ? 96 : 128;
  std::vector<const char*> names{"torus", "menger-2", "barth"};
  if (!expensive) names.insert(names.end(), {"octic", "gyroid", "cube", "julia"});
  for (const char* name : names) {
    const Shape shape = gallery_shape(name);
    const Remote far = remote(shape);
    const SampleSet set = sampled(far.shape, resolution);
    expect_same(set, sampled(GetParam()(shape), resolution));
    EXPECT_LE(double(far.field->calls), 60 * nodes_of(set.grid)) << name;
    EXPECT_EQ(far.field->single_points, 0u) << name;
    // Smooth fields take three for each root, those with kinks, and where f is 0 at the first guess, up to twenty.
    const double of_roots = 20.0 * double(set.size());
    EXPECT_LE(double(far.field->asked), 1.06 * points_of(set.grid) + of_roots) << name;
  }
}

TEST_P(RemoteForms, HardlyMorePointsThanTheGridHas) {
  const Remote far = remote(gallery_shape("sphere"));
  const SampleSet set = sampled(far.shape, 160);
  EXPECT_LE(double(far.field->asked), 1.15 * points_of(set.grid));
  EXPECT_LE(far.field->calls, 300u);
}

TEST_P(RemoteForms, AlikeForAnyNumberOfThreads) {
  const Remote far = remote(gallery_shape("octic"), 0);
  expect_same(sampled(far.shape, 150, 1), sampled(far.shape, 150, 2));
}

TEST_P(RemoteForms, BoundsCutItAsOthers) {
  Shape shape = shape_from_expression("x^2+y^2-0.25+0.1*sin(5z)", {}, {{-1, -1, -0.7}, {1, 1, 0.83}});
  expect_same(sampled(remote(shape).shape, 100), sampled(GetParam()(shape), 100));
  EXPECT_TRUE(sampled(remote(shape).shape, 100).cut_by_bounds);
  // Bounds much smaller than the grid, as for operands of a boolean.
  const Grid grid = make_grid({{-3, -3, -3}, {3, 3, 3}}, 200);
  shape.bounds = {{-0.31, -0.4, -0.2}, {0.9, 0.37, 0.11}};
  const Remote far = remote(shape);
  expect_same(sample_shape(far.shape, grid), sample_shape(GetParam()(shape), grid));
  EXPECT_LE(double(far.field->asked), 0.1 * points_of(grid));
}

TEST_P(RemoteForms, ABoundOnTheSlopePrunes) {
  const Shape shape =
      shape_from_expression("sqrt((sqrt(x^2+y^2)-1)^2+z^2)-0.35", {}, {{-1.4, -1.4, -0.4}, {1.4, 1.4, 0.4}});
  const Remote far = remote(shape, 1.0001);
  const SampleSet set = sampled(far.shape, 256);
  expect_same(set, sampled(GetParam()(shape), 256));
  // Where gradients are dear, they are asked for once more, at the root.
  const double once_more = far.field->differentiates() ? 0 : double(set.size());
  EXPECT_LE(double(far.field->asked), 16.0 * double(set.size()) + once_more);
  EXPECT_LE(double(far.field->asked), 0.5 * points_of(set.grid) + once_more);
  EXPECT_LE(double(far.field->calls), 60 * nodes_of(set.grid));
}

TEST_P(RemoteForms, ABoundThatIsTooLowTearsNothing) {
  const Shape shape =
      shape_from_expression("sqrt((sqrt(x^2+y^2)-1)^2+z^2)-0.35", {}, {{-1.4, -1.4, -0.4}, {1.4, 1.4, 0.4}});
  expect_same(sampled(remote(shape, 0.55).shape, 256), sampled(GetParam()(shape), 256));
}

TEST_P(RemoteForms, StaysOneWhereItIsMoved) {
  const Shape shape = transformed(GetParam()(gallery_shape("torus")), Affine::rotate({1, 2, 3}, 40));
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

TEST_P(RemoteForms, ABoxAroundItIsNoInterval) {
  Shape shape = shape_from_expression("x^2+y^2-0.5", {}, {{-1, -1, -1}, {1, 1, 1}});
  const Remote far = remote(shape);
  const Affine turn = Affine::rotate({0, 0, 1}, 30);
  const SampleSet set = sampled(transformed(far.shape, turn), 100);
  expect_same(set, sampled(transformed(GetParam()(shape), turn), 100));
  EXPECT_LE(double(far.field->asked), 1.06 * points_of(set.grid) + 20.0 * double(set.size()));
}

}  // namespace evenmesh::testing
