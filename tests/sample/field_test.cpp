// Fields that are no expressions, and what is asked of the sampling itself.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "evenmesh/error.h"
#include "grid/sample_checks.h"
#include "sample/field_checks.h"
#include "test_fields.h"

namespace evenmesh {
namespace testing {

INSTANTIATE_TEST_SUITE_P(Field, SampleForms, ::testing::Values(on_cpu, plain, expensive), name_of_form);
INSTANTIATE_TEST_SUITE_P(Cpu, GallerySamples, gallery_in(on_cpu), name_of_gallery_form);

}  // namespace testing
namespace {

constexpr double pi = std::numbers::pi;

double torus(double x, double y, double z) {
  const double ring = std::sqrt(x * x + y * y) - 1;
  return ring * ring + z * z - 0.35 * 0.35;
}

Shape ball() {
  return {"ball", {{-1.1, -1.1, -1.1}, {1.1, 1.1, 1.1}}, std::make_shared<const BallField>(), false};
}

TEST(SampleField, PruningChangesNothing) {
  const auto f = [](double x, double y, double z) {
    const auto u = static_cast<float>(x), v = static_cast<float>(y), w = static_cast<float>(z);
    return u * u + v * v + w * w - 1.0f;
  };
  const SampleSet pruned = sampled(ball(), 70), all = sampled(field_shape(f, ball().bounds), 70);
  EXPECT_TRUE(same_bytes(pruned.edge, all.edge));
}

TEST(SampleField, IndicatorsGetNormalsFromTheirNeighbours) {
  const auto f = [](double x, double y, double z) { return torus(x, y, z) < 0 ? -1.0 : 1.0; };
  const Shape shape = field_shape(f, {{-1.4, -1.4, -0.4}, {1.4, 1.4, 0.4}}, false);
  const SampleSet set = sampled(shape, 80, 1);
  expect_one_sign_grid(set);
  EXPECT_NEAR(set.total_area, 4 * pi * pi * 0.35, 0.015 * 4 * pi * pi * 0.35);
  double worst = 1, sum = 0;
  for (const SampleBlock& b : set.blocks)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      const Vec3 p = position(set, b, i);
      const double r = std::hypot(p.x, p.y);
      const Vec3 exact = normalized({p.x - p.x / r, p.y - p.y / r, p.z});
      EXPECT_NEAR(std::hypot(r - 1, p.z), 0.35, 1e-3 * set.grid.spacing);
      const double c = dot(exact, unpack_normal(set.normal[i]));
      worst = std::min(worst, c), sum += c;
    }
  EXPECT_GT(worst, 0.97);
  EXPECT_GT(sum / double(set.size()), 0.9995);
  expect_same(set, sampled(shape, 80, 2));
}

TEST(SampleField, CancelStops) {
  evenmesh::ExecutionContext context;
  context.cancel();
  EXPECT_THROW(sample_shape(ball(), make_grid(ball().bounds, 50), context), Cancelled);
}

}  // namespace
}  // namespace evenmesh
