/// Columns, copies of some samples, and weights.
#include "grid/sample_set.h"

#include <numeric>
#include <set>

#include "core/random.h"
#include "geometry/primitives.h"
#include "grid/blocks.h"
#include "grid/brick_cubes.h"
#include "grid/coarsen.h"
#include "grid/density.h"
#include "grid/sample_checks.h"

namespace evenmesh {
namespace {

SampleSet weighted(const SampleSet& even, const Density& density, unsigned threads = 1) {
  evenmesh::ExecutionContext context(threads);
  return with_threads(context, [&] { return weigh_by_density(even, density, context).samples; });
}

TEST(Columns, EachIsVisitedOnce) {
  SampleSet set = sampled(make_icosphere(2), 20);
  set.weight = set.area;
  std::set<const void*> visited;
  std::size_t visits = 0;
  for_each_column(
      [&](const auto& column) {
        visited.insert(&column);
        ++visits;
        EXPECT_EQ(column.size(), set.size());
      },
      set);
  EXPECT_EQ(visits, 8u);
  EXPECT_EQ(visited, (std::set<const void*>{&set.x, &set.y, &set.z, &set.area, &set.weight, &set.normal, &set.edge,
                                            &set.source}));
}

TEST(KeepSamples, LeavesTheRestAsItWas) {
  for (const bool with_sources : {true, false})
    for (const bool even : {true, false}) {
      SampleSet before = sampled(make_torus(), 32);
      before.source.resize(with_sources ? before.size() : 0);
      std::iota(before.source.begin(), before.source.end(), 0u);
      if (!even) before = weighted(before, [](const Vec3& p) { return 2 + p.x; });
      Random random(3);
      std::vector<char> kept(before.size());
      for (char& k : kept) k = random.below(3) == 0;
      for (std::uint32_t i = before.blocks[2].begin; i < before.blocks[2].end; ++i) kept[i] = 0;
      const SampleSet set = keep_samples(before, [&](std::uint32_t i) { return kept[i] != 0; });
      ASSERT_EQ(set.size(), static_cast<std::size_t>(std::count(kept.begin(), kept.end(), 1)));
      expect_well_formed(set);
      EXPECT_LT(set.blocks.size(), before.blocks.size()) << "blocks without samples go";
      EXPECT_EQ(set.source.size(), with_sources ? set.size() : 0);
      EXPECT_EQ(set.weight.size(), even ? 0 : set.size());
      std::vector<Vec3> expected, got;
      std::vector<float> weight;
      for (const SampleBlock& b : before.blocks)
        for (std::size_t i = b.begin; i < b.end; ++i)
          if (kept[i]) {
            expected.push_back(position(before, b, i));
            weight.push_back(before.weights()[i]);
          }
      for (const SampleBlock& b : set.blocks)
        for (std::size_t i = b.begin; i < b.end; ++i) got.push_back(position(set, b, i));
      EXPECT_EQ(got, expected);
      EXPECT_TRUE(std::equal(weight.begin(), weight.end(), set.weights().begin()));
      EXPECT_NEAR(set.total_weight, std::accumulate(weight.begin(), weight.end(), 0.0), 1e-6 * before.total_weight);
      for (std::size_t i = 0; i < set.source.size(); ++i) EXPECT_TRUE(kept[set.source[i]]);
    }
}

TEST(KeepSamples, AllOrNone) {
  const SampleSet before = sampled(make_icosphere(2), 24);
  expect_same(keep_samples(before, [](std::uint32_t) { return true; }), before);
  const SampleSet none = keep_samples(before, [](std::uint32_t) { return false; });
  EXPECT_EQ(none.size(), 0u);
  EXPECT_TRUE(none.blocks.empty());
  EXPECT_NEAR(none.total_area, 0, 1e-9);
}

TEST(Gather, RefusesIndicesThatDoNotAscend) {
  const SampleSet set = sampled(make_icosphere(1), 12);
  EXPECT_THROW(gather(set, std::vector<std::uint32_t>{3, 2}), std::logic_error);
  EXPECT_THROW(gather(set, std::vector<std::uint32_t>{static_cast<std::uint32_t>(set.size())}), std::logic_error);
}

TEST(Density, AreasStayAndWeightsAreThoseOfTheWantedEdges) {
  const SampleSet even = sampled(make_icosphere(4), 60);
  const Density density = [](const Vec3& p) { return 3 * (2 + p.z); };
  const SampleSet set = weighted(even, density);
  EXPECT_TRUE(same_bytes(set.area, even.area));
  EXPECT_EQ(set.total_area, even.total_area);
  ASSERT_EQ(set.weight.size(), set.size());
  EXPECT_TRUE(even.even());
  const double mean = 3 * 2;  // over the ball
  double weight = 0, share = 0;
  for (const SampleBlock& b : set.blocks)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      // Edges shrink with the root of the density, the weight grows with their fourth power.
      const double edge = std::sqrt(mean / density(position(set, b, i)));
      ASSERT_NEAR(set.weight[i], set.area[i] / std::pow(edge, 4), 0.01 * set.weight[i] + 1e-12);
      ASSERT_NEAR(set.share(i), set.area[i] / (edge * edge), 0.01 * set.share(i) + 1e-12);
      weight += set.weight[i];
      share += set.share(i);
    }
  EXPECT_NEAR(share, set.total_area, 1e-4 * set.total_area) << "shares add up to the area";
  EXPECT_NEAR(set.total_weight, weight, 1e-6 * weight);
  EXPECT_GT(set.total_weight, set.total_area);
}

TEST(Density, UnitsDoNotMatterAndAConstantOneGivesAreas) {
  const SampleSet even = sampled(make_torus(), 40);
  const SampleSet one = weighted(even, [](const Vec3& p) { return 2 + p.x; });
  const SampleSet many = weighted(even, [](const Vec3& p) { return 1024 * (2 + p.x); });
  EXPECT_TRUE(same_bytes(one.weight, many.weight));
  const SampleSet constant = weighted(even, [](const Vec3&) { return 7.0; });
  for (std::size_t i = 0; i < even.size(); ++i) ASSERT_NEAR(constant.weight[i], even.area[i], 1e-5f * even.area[i]);
}

/// Cubes that reach into what was left out are not walked; the others are those of the whole.
TEST(PartOf, IsWalkedLikeTheWhole) {
  evenmesh::ExecutionContext context(1);
  const SampleSet whole = sampled(make_torus(), 60);
  std::vector<std::uint32_t> blocks;
  for (std::uint32_t b = 0; b < whole.blocks.size(); ++b)
    if (whole.block_center(whole.blocks[b]).x > 0.2) blocks.push_back(b);
  const SampleSet part = part_of(whole, blocks);
  EXPECT_EQ(part.blocks.size(), blocks.size());
  EXPECT_FALSE(part.left_out.empty());
  EXPECT_EQ(part.total_area, whole.total_area);
  const auto loops = [&](const SampleSet& set) {
    std::size_t count = 0;
    CubeWalker walker(set);
    for (const CubeBrick& brick : cube_bricks(set, context))
      if (8 * brick.at[0] > 0.6 * set.grid.size[0]) walker.walk(brick, [&](const std::uint32_t*, int) { ++count; });
    return count;
  };
  EXPECT_GT(loops(part), 100u);
  EXPECT_EQ(loops(part), loops(whole));
}

TEST(Density, TellsItsMeanAndTheLargest) {
  evenmesh::ExecutionContext context(1);
  const SampleSet even = sampled(make_icosphere(4), 60);
  const WeightedSamples made = weigh_by_density(
      even, [](const Vec3& p) { return 2 + p.z; }, context);
  EXPECT_NEAR(made.mean_density, 2, 0.01);
  EXPECT_NEAR(made.max_density, 3, 0.01);
}

TEST(Density, ThreadsDoNotMatterAndWeightsAreCoarsenedAsAreas) {
  const SampleSet even = sampled(make_torus(), 60);
  const Density density = [](const Vec3& p) { return 1 + 4 * std::exp(-4 * p.x * p.x); };
  const SampleSet set = weighted(even, density, 1);
  expect_same(set, weighted(even, density, 3));
  const SampleSet coarse = coarsen(set);
  ASSERT_EQ(coarse.weight.size(), coarse.size());
  EXPECT_NEAR(coarse.total_weight, set.total_weight, 0.05 * set.total_weight);
  EXPECT_NEAR(coarse.total_area, set.total_area, 0.05 * set.total_area);
}

}  // namespace
}  // namespace evenmesh
