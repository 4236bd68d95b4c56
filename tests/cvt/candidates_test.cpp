#include "cvt/candidates.h"

#include "cvt/cvt_testing.h"

namespace evenmesh {
namespace {

Vec3 random_step(Random& random) {
  const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
  return {x, y, z};
}

/// One evaluator that has seen all earlier seeds, against one that sees these for the first time.
void expect_as_fresh(CellEvaluator& kept, const SampleSet& samples, const std::vector<Vec3>& seeds) {
  evenmesh::ExecutionContext context(1);
  CpuCellEvaluator fresh(samples, context);
  CellSums one, other;
  kept.evaluate(seeds, one), fresh.evaluate(seeds, other);
  EXPECT_EQ(one.energy, other.energy);
  EXPECT_EQ(one.mass, other.mass);
  EXPECT_EQ(one.moment, other.moment);
  std::vector<std::uint32_t> one_label, other_label;
  kept.nearest(seeds, one_label), fresh.nearest(seeds, other_label);
  EXPECT_EQ(one_label, other_label);
}

TEST(Candidates, StayCompleteWhileSeedsMove) {
  evenmesh::ExecutionContext context(2);
  const SampleSet sets[] = {sampled(make_torus(), 40), sampled(make_box({1, 0.6, 0.05}), 40)};
  for (const SampleSet& samples : sets) {
    const double spacing = spacing_of(samples, 120);
    // Steps in seed spacings: creeping, within margins, beyond them, leaps.
    for (const double step : {0.001, 0.03, 0.15, 0.6, 3.0}) {
      SCOPED_TRACE(step);
      CpuCellEvaluator kept(samples, context);
      std::vector<Vec3> seeds = random_start(samples, 120, 1);
      Random random(9);
      for (int round = 0; round < 12; ++round) {
        expect_as_fresh(kept, samples, seeds);
        for (Vec3& s : seeds) s += step * spacing * random_step(random);
      }
    }
  }
}

TEST(Candidates, StayCompleteWhenFewSeedsStray) {
  evenmesh::ExecutionContext context(2);
  const SampleSet samples = sampled(make_torus(), 48);
  const double spacing = spacing_of(samples, 200);
  CpuCellEvaluator kept(samples, context);
  std::vector<Vec3> seeds = random_start(samples, 200, 2);
  Random random(4);
  for (int round = 0; round < 40; ++round) {
    expect_as_fresh(kept, samples, seeds);
    for (Vec3& s : seeds) s += 0.01 * spacing * random_step(random);
    for (int i = 0; i < 3; ++i) {  // a neighbour's step, or across the torus, and back
      Vec3& s = seeds[random.below(seeds.size())];
      s = round % 3 == 0 ? -s : s + spacing * random_step(random);
    }
  }
}

TEST(Candidates, FollowSeedsThatComeAndGo) {
  evenmesh::ExecutionContext context(2);
  const SampleSet samples = sampled(make_icosphere(3), 40);
  CpuCellEvaluator kept(samples, context);
  for (const std::size_t count : {100u, 101u, 100u, 1u, 2u, 400u, 3u}) {
    SCOPED_TRACE(count);
    expect_as_fresh(kept, samples, random_start(samples, count, count));
  }
}

TEST(Candidates, NearestTwoAreAlwaysAmongThem) {
  evenmesh::ExecutionContext context(2);
  const SampleSet samples = sampled(make_torus(), 32);
  const auto points = positions_of(samples);
  CandidateLists lists(samples, context);
  std::vector<Vec3> seeds = random_start(samples, 80, 5);
  const double spacing = spacing_of(samples, seeds.size());
  Random random(6);
  for (int round = 0; round < 15; ++round) {
    lists.update(seeds, context);
    std::size_t missing = 0, unsorted = 0;
    for (std::size_t b = 0; b < samples.blocks.size(); ++b) {
      const auto list = lists.of_block(b);
      ASSERT_FALSE(list.empty());
      unsorted += !std::is_sorted(list.begin(), list.end());
      for (std::size_t i = samples.blocks[b].begin; i < samples.blocks[b].end; ++i) {
        std::array<std::pair<double, std::uint32_t>, 2> two{{{1e300, 0}, {1e300, 0}}};
        for (std::uint32_t s = 0; s < seeds.size(); ++s)
          if (const std::pair at{norm(points[i] - seeds[s]), s}; at < two[1])
            two[1] = at, std::sort(two.begin(), two.end());
        // Rounding may decide between seeds that are as near.
        if (two[1].first - two[0].first < 1e-5 * spacing) continue;
        missing += !std::binary_search(list.begin(), list.end(), two[0].second);
        missing += !std::binary_search(list.begin(), list.end(), two[1].second);
      }
    }
    EXPECT_EQ(missing, 0u) << "round " << round;
    EXPECT_EQ(unsorted, 0u);
    for (Vec3& s : seeds) s += (round % 5 == 4 ? 0.5 : 0.04) * spacing * random_step(random);
  }
}

}  // namespace
}  // namespace evenmesh
