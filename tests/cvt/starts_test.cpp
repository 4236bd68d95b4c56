#include "cvt/starts.h"

#include <numbers>

#include "cvt/cvt_testing.h"
#include "grid/density.h"

namespace evenmesh {
namespace {

double smallest_distance(const std::vector<Vec3>& seeds) {
  double smallest = 1e300;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) smallest = std::min(smallest, norm(seeds[i] - seeds[j]));
  return smallest;
}

TEST(Starts, RandomSeedsAreSpreadByArea) {
  // A ball of nine times the area of the other gets nine times the seeds.
  const SampleSet samples = sampled(merged(make_icosphere(4), translated(make_icosphere(4, 1.0 / 3), {2, 0, 0})), 80);
  const auto seeds = random_start(samples, 1000, 5);
  ASSERT_EQ(seeds.size(), 1000u);
  const auto on_small = std::count_if(seeds.begin(), seeds.end(), [](const Vec3& s) { return s.x > 1.5; });
  EXPECT_NEAR(static_cast<double>(on_small), 100, 12);
  EXPECT_EQ(seeds, random_start(samples, 1000, 5));
  EXPECT_NE(seeds, random_start(samples, 1000, 6));
}

TEST(Starts, DensityDrawsByShare) {
  evenmesh::ExecutionContext context(1);
  const SampleSet even = sampled(make_icosphere(4), 80);
  const auto top_heavy = [](const Vec3& p) { return p.z > 0 ? 9.0 : 1.0; };
  const SampleSet samples = weigh_by_density(even, top_heavy, context).samples;
  const auto seeds = random_start(samples, 1000, 5);
  ASSERT_EQ(seeds.size(), 1000u);
  const auto above = std::count_if(seeds.begin(), seeds.end(), [](const Vec3& s) { return s.z > 0; });
  EXPECT_NEAR(static_cast<double>(above), 900, 5);
}

TEST(Starts, MoreSeedsThanSamplesAreStillGiven) {
  const SampleSet samples = sampled(make_icosphere(1), 8);
  EXPECT_EQ(random_start(samples, 2 * samples.size(), 1).size(), 2 * samples.size());
  EXPECT_EQ(blue_noise_start(samples, samples.size(), 1).size(), samples.size());
}

TEST(Starts, BlueNoiseKeepsItsDistance) {
  const SampleSet samples = sampled(make_icosphere(4), 80);
  const std::size_t count = 500;
  const auto random = random_start(samples, count, 1), blue = blue_noise_start(samples, count, 1);
  ASSERT_EQ(blue.size(), count);
  const double densest = 2 * std::sqrt(samples.total_area / (2 * std::sqrt(3.0) * static_cast<double>(count)));
  EXPECT_GT(smallest_distance(blue), 0.5 * densest);
  EXPECT_GT(smallest_distance(blue), 3 * smallest_distance(random));
  EXPECT_EQ(blue, blue_noise_start(samples, count, 1));
}

TEST(Starts, SplittingQuadruplesRegularSeeds) {
  evenmesh::ExecutionContext context(2);
  const SampleSet samples = sampled(make_icosphere(5), 160, 2);
  CpuCellEvaluator evaluator(samples, context);
  const std::vector<Vec3> seeds = relaxed_seeds(samples, 200);
  const std::vector<Vec3> middles = neighbour_middles(evaluator, seeds, context);
  EXPECT_NEAR(static_cast<double>(middles.size()), 3 * 200 - 6, 8);  // Euler: edges of a triangulated sphere
  std::vector<Vec3> split = seeds;
  split.insert(split.end(), middles.begin(), middles.end());
  for (std::size_t i = seeds.size(); i < split.size(); ++i)
    EXPECT_NEAR(norm(split[i]), 1, 0.01) << "new seeds lie on the surface";
  EXPECT_GT(smallest_distance(split), 0.4 * spacing_of(samples, split.size()));
  CellSums sums;
  evaluator.evaluate(split, sums);
  EXPECT_LT(energy_ratio(sums.energy, split.size(), samples.total_area), 1.06) << "balanced even before any iteration";
}

TEST(Starts, AdjustCountMeetsAnyCount) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_torus(), 60);
  CpuCellEvaluator evaluator(samples, context);
  const std::vector<Vec3> seeds = random_start(samples, 100, 3);
  for (const std::size_t count : {4u, 50u, 99u, 100u, 101u, 130u, 200u, 450u}) {
    Seeds adjusted = seeds;
    adjust_count(evaluator, adjusted, count, 1, context);
    ASSERT_EQ(adjusted.size(), count);
    if (count >= 100) {
      EXPECT_TRUE(std::equal(seeds.begin(), seeds.end(), adjusted.positions.begin()));
    }
    for (const Vec3& s : adjusted.positions) EXPECT_TRUE(is_finite(s));
  }
}

TEST(Starts, AdjustCountMeetsTheCountWithEmptyCells) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_torus(), 60);
  CpuCellEvaluator evaluator(samples, context);
  std::vector<Vec3> seeds = random_start(samples, 50, 3);
  for (std::size_t i = 0; i < 50; ++i) seeds.push_back(seeds[i]);  // the twin of every seed owns nothing
  for (const std::size_t count : {60u, 101u, 150u, 180u, 260u}) {
    Seeds adjusted = seeds;
    adjust_count(evaluator, adjusted, count, 1, context);
    EXPECT_EQ(adjusted.size(), count);
  }
}

TEST(Starts, AdjustCountHelpsTheHeaviestAndTakesTheLightest) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_icosphere(4), 60);
  CpuCellEvaluator evaluator(samples, context);
  std::vector<Vec3> seeds = relaxed_seeds(samples, 100);
  const Vec3 crowded = seeds[10] + Vec3{0.01, 0.01, 0};
  seeds.push_back(crowded);
  Seeds fewer = seeds;
  adjust_count(evaluator, fewer, 100, 1, context);
  ASSERT_EQ(fewer.size(), 100u);
  CellSums before, after;
  evaluator.evaluate(seeds, before);
  evaluator.evaluate(fewer, after);
  EXPECT_GT(*std::min_element(after.mass.begin(), after.mass.end()),
            *std::min_element(before.mass.begin(), before.mass.end()));
}

}  // namespace
}  // namespace evenmesh
