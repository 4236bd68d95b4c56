#pragma once
/// Fields that want large batches, wherever they are evaluated, from end to end.

#include <memory>
#include <numbers>
#include <variant>

#include "evenmesh/solid.h"
#include "pipeline/pipeline_testing.h"
#include "shape/forms.h"
#include "shape/remote_field.h"

namespace evenmesh::testing {

class RemoteMeshes : public FormTest {
 protected:
  std::shared_ptr<const RemoteField> remote(const Shape& shape, double slope = 0) const {
    const auto inner = std::get<std::shared_ptr<const Field>>(GetParam()(shape, slope).what);
    return std::make_shared<const RemoteField>(inner, slope);
  }
};

inline MeshResult expect_meshed(const std::shared_ptr<const RemoteField>& field, const MeshOptions& options) {
  const MeshResult result = meshed({"remote", {}, field, false}, options);
  expect_good_mesh(result);
  EXPECT_EQ(field->single_points, 0u);
  EXPECT_LE(field->calls, 2000u);
  return result;
}

TEST_P(RemoteMeshes, IsMeshedWithoutBounds) {
  const Shape shape = shape_from_expression("x^4-5x^2+y^4-5y^2+z^4-5z^2+11.8");
  const MeshResult plain = meshed(shape, {.vertices = 3000});
  const MeshResult result = expect_meshed(remote(shape), {.vertices = 3000});
  expect_count(result, 3000);
  EXPECT_EQ(result.report.quality.euler, plain.report.quality.euler);
  EXPECT_NEAR(result.report.quality.volume, plain.report.quality.volume, 2e-3 * plain.report.quality.volume);
}

TEST_P(RemoteMeshes, IsMeshedWithASlope) {
  const Shape shape = shape_from_expression("sqrt((sqrt(x^2+y^2)-1)^2+z^2)-0.35");
  const MeshResult result = expect_meshed(remote(shape, 1.0001), {.vertices = 2000});
  EXPECT_EQ(result.report.quality.euler, 0);
  const double volume = 2 * std::numbers::pi * std::numbers::pi * 0.35 * 0.35;
  EXPECT_NEAR(result.report.quality.volume, volume, 0.01 * volume);
  for (const Vec3& p : result.mesh.vertices) EXPECT_NEAR(shape.field()->evaluate(p, nullptr), 0, 1e-5);
}

TEST_P(RemoteMeshes, IsMeshedByShells) {
  const Shape shape = gallery_shape("sphere");
  const auto field = remote(shape);
  const MeshResult result = meshed({"remote", {}, field, false}, {.vertices = 1000, .method = Method::shell});
  EXPECT_TRUE(result.report.quality.two_manifold());
  EXPECT_EQ(field->single_points, 0u);
}

TEST_P(RemoteMeshes, IsAnOperandAsOthers) {
  const auto field = remote(shape_from_expression("r-1"));
  const Shape ball{"ball", {}, field, false};
  const Shape solid = subtract(shape_from_box({{-2, -2, -2}, {2, 2, 0}}), {ball});
  const MeshResult result = meshed(solid, {.vertices = 3000});
  expect_good_mesh(result);
  EXPECT_NEAR(result.report.quality.volume, 32 - 2 * std::numbers::pi / 3, 0.1);
  EXPECT_EQ(field->single_points, 0u);
}

}  // namespace evenmesh::testing
