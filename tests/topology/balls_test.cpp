#include "topology/balls.h"

#include <gtest/gtest.h>

#include "evenmesh/shape.h"
#include "grid/density.h"
#include "grid/surface_components.h"
#include "sample/sample.h"
#include "topology/ambiguous_faces.h"

namespace evenmesh {
namespace {

const Box box{{-2, -2, -2}, {2, 2, 2}};

SampleSet sampled(const char* expression, std::size_t resolution = 40) {
  return sample_shape(shape_from_expression(expression, {}, box), make_grid(box, resolution));
}

/// Crossings of a set, named by brick and edge.
std::vector<std::array<std::uint32_t, 4>> crossings(const SampleSet& set) {
  std::vector<std::array<std::uint32_t, 4>> list;
  for (const SampleBlock& b : set.blocks)
    for (std::uint32_t i = b.begin; i < b.end; ++i)
      list.push_back({b.brick[0], b.brick[1], b.brick[2], set.edge[i].bits});
  return list;
}

TEST(Balls, UnionHasTheCrossingsOfTheUnitedSolid) {
  evenmesh::ExecutionContext context(2);
  const SampleSet ball = sampled("r - 1");
  // One that overlaps, one apart, one within.
  const std::vector<Ball> balls{{{1, 0.1, 0}, 0.4}, {{-0.3, 1.4, 0.2}, 0.3}, {{0, 0, 0}, 0.5}};
  const SampleSet made = unite_balls(ball, balls, context);
  const SampleSet wanted =
      sampled("min(r - 1, sqrt((x-1)^2+(y-0.1)^2+z^2) - 0.4, sqrt((x+0.3)^2+(y-1.4)^2+(z-0.2)^2) - 0.3)");
  ASSERT_EQ(crossings(made), crossings(wanted));
  EXPECT_NEAR(made.total_area, wanted.total_area, 1e-3 * wanted.total_area);
  for (std::size_t b = 0; b < made.blocks.size(); ++b) {
    EXPECT_EQ(made.blocks[b].axis_begin, wanted.blocks[b].axis_begin);
    for (std::uint32_t i = made.blocks[b].begin; i < made.blocks[b].end; ++i) {
      EXPECT_NEAR(made.x[i], wanted.x[i], 1e-4);
      EXPECT_NEAR(made.y[i], wanted.y[i], 1e-4);
      EXPECT_NEAR(made.z[i], wanted.z[i], 1e-4);
    }
  }
}

TEST(Balls, WeighWhatTheSurfaceAroundThemDoes) {
  evenmesh::ExecutionContext context(2);
  const Density density = [](const Vec3& p) { return p.x > 0 ? 3.0 : 1.0; };
  const SampleSet ball = weigh_by_density(sampled("r - 1", 80), density, context).samples;
  const SampleSet made = unite_balls(ball, std::vector<Ball>{{{1, 0, 0}, 0.3}, {{-1, 0, 0}, 0.3}}, context);
  ASSERT_EQ(made.weight.size(), made.size());
  double total = 0;
  for (const SampleBlock& b : made.blocks)
    for (std::uint32_t i = b.begin; i < b.end; ++i) {
      const double x = made.block_center(b).x + made.x[i], n = (x > 0 ? 3.0 : 1.0) / 2;
      ASSERT_NEAR(made.weight[i], made.area[i] * n * n, 0.02f * made.weight[i] + 1e-12f);
      total += made.weight[i];
    }
  EXPECT_NEAR(made.total_weight, total, 1e-6 * total);
}

TEST(Balls, TheGridsBorderStaysOutside) {
  evenmesh::ExecutionContext context(1);
  const SampleSet made = unite_balls(sampled("r - 1"), std::vector<Ball>{{{2, 0, 0}, 0.7}}, context);
  EXPECT_EQ(surface_components(made, context).area.size(), 2u);  // walks every cube: they all close up
  for (const SampleBlock& b : made.blocks)
    for (std::uint32_t i = b.begin; i < b.end; ++i)
      EXPECT_LT((made.block_center(b).x + made.x[i] - made.grid.origin.x) / made.grid.spacing, made.grid.size[0] - 1.0);
}

TEST(Balls, OutsideLeavesTheBallsByTheNearestWay) {
  const BallIndex index({{{0, 0, 0}, 1}, {{1.5, 0, 0}, 1}});
  EXPECT_EQ(index.outside({0, 2, 0}), (Vec3{0, 2, 0}));
  EXPECT_NEAR(norm(index.outside({-0.5, 0, 0}) - Vec3{-1, 0, 0}), 0, 1e-12);
  const Vec3 out = index.outside({0.8, 0.1, 0});
  for (const Ball& b : index.balls()) EXPECT_GE(norm(out - b.center), (1 - 1e-3) * b.radius);
  EXPECT_EQ(BallIndex({}).outside({1, 2, 3}), (Vec3{1, 2, 3}));
}

TEST(AmbiguousFaces, AreWhereSheetsPassWithinACell) {
  evenmesh::ExecutionContext context(2);
  EXPECT_TRUE(find_ambiguous_faces(sampled("(sqrt(x^2+y^2)-1)^2+z^2-0.16"), context).empty());
  // Two bodies that share an edge, diagonally.
  const auto ambiguous_faces = find_ambiguous_faces(sampled("max(max(abs(x),abs(y),abs(z)) - 1, -x*y)"), context);
  ASSERT_FALSE(ambiguous_faces.empty());
  for (const Vec3& p : ambiguous_faces) EXPECT_LT(std::hypot(p.x, p.y), 0.3);
}

}  // namespace
}  // namespace evenmesh
