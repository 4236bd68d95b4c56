#include "grid/coarsen.h"

#include <gtest/gtest.h>

#include <numbers>

#include "geometry/primitives.h"
#include "grid/sample_checks.h"
#include "sample/sample.h"

namespace evenmesh {
namespace {

TEST(Coarsen, KeepsAreaAndAQuarterOfTheSamples) {
  const SampleSet fine = sampled(make_torus(1, 0.35, 96, 48), 160);
  const SampleSet half = coarsen(fine), quarter = coarsen(half);
  EXPECT_NEAR(half.total_area, fine.total_area, 0.02 * fine.total_area);
  EXPECT_NEAR(quarter.total_area, fine.total_area, 0.05 * fine.total_area);
  EXPECT_NEAR(double(half.size()), double(fine.size()) / 4, 0.02 * double(fine.size()));
  EXPECT_NEAR(double(quarter.size()), double(fine.size()) / 16, 0.01 * double(fine.size()));
  EXPECT_EQ(half.edge.size(), half.size());
  EXPECT_EQ(half.source.size(), half.size());
}

TEST(Coarsen, SamplesStayWhereTheyWere) {
  SampleSet set = sampled(make_torus(1, 0.35, 96, 48), 100);
  for (int level = 0; level < 2; ++level) {
    set = coarsen(set);
    std::uint32_t next = 0;
    std::uint64_t last = 0;
    for (const SampleBlock& b : set.blocks) {
      EXPECT_EQ(b.begin, next);
      EXPECT_LT(b.begin, b.end);
      next = b.end;
      const std::uint64_t code = morton_code(b.brick[0], b.brick[1], b.brick[2]);
      EXPECT_TRUE(b.begin == 0 || last < code);
      last = code;
      for (std::size_t i = b.begin; i < b.end; ++i) {
        const Vec3 p = position(set, b, i);
        // The facets of the torus lie inside of it, by less than 1 %.
        const double distance = std::hypot(std::hypot(p.x, p.y) - 1, p.z);
        EXPECT_NEAR(distance, 0.35, 0.0035);
        const double half_brick = 4.001 * set.grid.spacing;
        EXPECT_LE(std::max({std::abs(set.x[i]), std::abs(set.y[i]), std::abs(set.z[i])}), half_brick);
      }
    }
    EXPECT_EQ(next, set.size());
  }
}

TEST(Coarsen, OnEveryEdgeAtMostOneStays) {
  const SampleSet solid = one_sample_per_edge(coarsen(coarsen(sampled(make_torus(1, 0.35, 96, 48), 160))));
  EXPECT_NEAR(solid.total_area, 4 * std::numbers::pi * std::numbers::pi * 0.35, 0.05 * solid.total_area);
  for (const SampleBlock& b : solid.blocks)
    for (std::size_t i = b.begin; i + 1 < b.end; ++i) EXPECT_LT(solid.edge[i].bits >> 1, solid.edge[i + 1].bits >> 1);
}

TEST(Coarsen, WhatIsThinnerThanACellGoes) {
  const Mesh plate = make_box({1, 1, 0.01});
  const SampleSet fine = sampled(plate, 300);
  SampleSet coarse = fine;
  for (int level = 0; level < 3; ++level) coarse = coarsen(coarse);
  EXPECT_GT(coarse.total_area, 0.9 * fine.total_area);
  EXPECT_LT(one_sample_per_edge(coarse).total_area, 0.1 * fine.total_area);
}

TEST(Coarsen, ThreadsDoNotMatter) {
  const SampleSet fine = sampled(make_icosphere(3), 90);
  evenmesh::ExecutionContext one(1), two(2);
  expect_same(coarsen(fine, one), coarsen(fine, two));
  expect_same(one_sample_per_edge(coarsen(fine), one), one_sample_per_edge(coarsen(fine), two));
}

}  // namespace
}  // namespace evenmesh
