// Fields that want large batches and know little.

#include <gtest/gtest.h>

#include "sample/remote_checks.h"
#include "test_fields.h"

namespace evenmesh {
namespace testing {

INSTANTIATE_TEST_SUITE_P(Sample, RemoteForms, ::testing::Values(on_cpu), name_of_form);

}  // namespace testing
namespace {

using testing::on_cpu;
using testing::points_of;
using testing::Remote;
using testing::remote;

TEST(RemoteField, IndicatorsAsWell) {
  const auto f = [](double x, double y, double z) { return x * x + 2 * y * y + 3 * z * z < 1 ? -1.0 : 1.0; };
  const Shape shape = field_shape(f, {{-1.1, -0.8, -0.7}, {1.1, 0.8, 0.7}}, false);
  const Remote far = remote(on_cpu, shape);
  expect_same(sampled(far.shape, 90), sampled(shape, 90));
  EXPECT_LE(far.field->calls, 100u);
}

TEST(RemoteField, FineGridsAreSketchedFirst) {
  for (const char* name : {"torus", "heart"}) {
    const Shape shape = gallery_shape(name);
    const Remote far = remote(on_cpu, shape);
    const SampleSet set = sampled(far.shape, 700);
    expect_same(set, sampled(shape, 700));
    EXPECT_LE(double(far.field->asked), 0.1 * points_of(set.grid) + 30.0 * double(set.size())) << name;
  }
}

}  // namespace
}  // namespace evenmesh
