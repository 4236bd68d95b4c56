#include "sample/dexels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "evenmesh/error.h"
#include "geometry/primitives.h"
#include "sample/sample.h"

namespace evenmesh {
namespace {

SampleSet sampled_torus() {
  evenmesh::ExecutionContext context(2);
  const Shape shape = gallery_shape("torus");
  return sample_shape(shape, make_grid(shape.bounds, 50), context);
}

TEST(Dexels, SamplesComeBack) {
  evenmesh::ExecutionContext context(2);
  const SampleSet set = sampled_torus();
  Dexels dexels = dexels_of(set);
  std::reverse(dexels.crossings.begin(), dexels.crossings.end());  // any order will do
  const SampleSet again = samples_of(dexels, context);
  ASSERT_EQ(again.size(), set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    ASSERT_EQ(again.edge[i].bits, set.edge[i].bits);
    ASSERT_EQ(again.normal[i].bits, set.normal[i].bits);
    ASSERT_NEAR(again.x[i], set.x[i], 1e-5 * set.grid.spacing * 50);
  }
  EXPECT_NEAR(again.total_area, set.total_area, 1e-3 * set.total_area);
  dexels.crossings = dexels_of(again).crossings;
  EXPECT_NO_THROW(shape_from_dexels(dexels));
}

TEST(Dexels, WhatBoundsNoSolidIsRefused) {
  const Dexels good = dexels_of(sampled_torus());
  const auto refused = [](const Dexels& dexels) { EXPECT_THROW(shape_from_dexels(dexels), UnusableInput); };
  Dexels bad = good;
  bad.crossings.pop_back();
  refused(bad);
  bad = good, bad.crossings.push_back(bad.crossings.front());
  refused(bad);
  bad = good, bad.crossings[7].leaves = !bad.crossings[7].leaves;
  refused(bad);
  bad = good, bad.crossings[7].point[1] = 60000;
  refused(bad);
  bad = good, bad.crossings[7].t = std::nanf("");
  refused(bad);
  bad = good, bad.crossings[7].axis = 3;
  refused(bad);
  bad = good, bad.spacing = 0;
  refused(bad);
  bad = good, bad.size = {1, 1, 1};
  refused(bad);
  refused(Dexels{});
}

}  // namespace
}  // namespace evenmesh
