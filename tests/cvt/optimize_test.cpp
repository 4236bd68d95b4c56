#include "cvt/optimize.h"

#include "cvt/cvt_testing.h"

namespace evenmesh {
namespace {

TEST(Optimize, LowersTheEnergyStepByStep) {
  evenmesh::ExecutionContext context(2);
  const SampleSet samples = sampled(make_torus(), 64);
  CpuCellEvaluator evaluator(samples, context);
  Seeds seeds = random_start(samples, 120, 1);
  CellSums sums;
  evaluator.evaluate(seeds, sums);
  const double start = sums.energy;
  const OptimizeResult result = optimize(evaluator, seeds, {.evaluations = 60}, context);
  evaluator.evaluate(seeds, sums);
  EXPECT_EQ(result.energy, sums.energy) << "the energy told is that of the seeds returned";
  ASSERT_FALSE(result.ratios.empty());
  EXPECT_LE(result.ratios.size(), 60u);
  EXPECT_EQ(result.ratios.front(), energy_ratio(start, 120, samples.total_area));
  EXPECT_LT(result.energy, 0.85 * start);
  const double final_ratio = energy_ratio(result.energy, 120, samples.total_area);
  EXPECT_EQ(*std::min_element(result.ratios.begin(), result.ratios.end()), final_ratio) << "only better seeds are kept";
}

TEST(Optimize, LloydLowersTheEnergyInEveryStep) {
  evenmesh::ExecutionContext context(2);
  const SampleSet samples = sampled(make_icosphere(4), 64);
  CpuCellEvaluator evaluator(samples, context);
  Seeds seeds = random_start(samples, 100, 1);
  const auto ratios = optimize(evaluator, seeds, {.lloyd = true, .evaluations = 40}, context).ratios;
  ASSERT_EQ(ratios.size(), 40u);
  for (std::size_t i = 1; i < ratios.size(); ++i) EXPECT_LT(ratios[i], ratios[i - 1] * (1 + 1e-4));
  EXPECT_LT(ratios.back(), 0.9 * ratios.front());
}

TEST(Optimize, QuasiNewtonBeatsLloydForTheSameWork) {
  evenmesh::ExecutionContext context(2);
  const SampleSet samples = sampled(make_icosphere(4), 64);
  CpuCellEvaluator evaluator(samples, context);
  double ratio[2];
  for (const bool lloyd : {false, true}) {
    Seeds seeds = random_start(samples, 100, 1);
    const auto result = optimize(evaluator, seeds, {.lloyd = lloyd, .evaluations = 60}, context);
    ratio[lloyd] = energy_ratio(result.energy, 100, samples.total_area);
  }
  EXPECT_LE(ratio[0], ratio[1] + 0.002);
}

TEST(Optimize, StopsWhereNothingMovesAnyMore) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_icosphere(3), 40);
  CpuCellEvaluator evaluator(samples, context);
  Seeds seeds = random_start(samples, 30, 1);
  optimize(evaluator, seeds, {.evaluations = 200, .tolerance = 1e-3}, context);
  const std::vector<Vec3> rest = seeds.positions;
  EXPECT_LE(optimize(evaluator, seeds, {.evaluations = 200, .tolerance = 1e-2}, context).ratios.size(), 2u);
  for (std::size_t i = 0; i < seeds.size(); ++i)
    EXPECT_LT(norm(seeds.positions[i] - rest[i]), 0.1 * spacing_of(samples, 30));
}

TEST(Optimize, NoEvaluationsLeaveTheSeedsAlone) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_icosphere(2), 24);
  CpuCellEvaluator evaluator(samples, context);
  Seeds seeds = random_start(samples, 20, 1);
  const std::vector<Vec3> before = seeds.positions;
  EXPECT_TRUE(optimize(evaluator, seeds, {.evaluations = 0}, context).ratios.empty());
  EXPECT_EQ(seeds.positions, before);
  EXPECT_EQ(optimize(evaluator, seeds, {.evaluations = 1}, context).ratios.size(), 1u);
  EXPECT_EQ(seeds.positions, before);
}

TEST(Optimize, FixedSeedsStay) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_torus(), 60);
  CpuCellEvaluator evaluator(samples, context);
  Seeds seeds = random_start(samples, 60, 1);
  seeds.fixed.resize(7);
  const std::vector<Vec3> before = seeds.positions;
  optimize(evaluator, seeds, {.evaluations = 20}, context);
  for (std::size_t i = 0; i < seeds.size(); ++i) EXPECT_EQ(seeds.positions[i] == before[i], seeds.is_fixed(i)) << i;
  for (const std::size_t count : {80u, 60u, 20u, 7u}) {
    adjust_count(evaluator, seeds, count, 1, context);
    ASSERT_EQ(seeds.size(), count);
    for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(seeds.positions[i], before[i]) << count;
  }
}

TEST(Optimize, SeedsWithoutSamplesDoNotHarm) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_icosphere(3), 40);
  CpuCellEvaluator evaluator(samples, context);
  Seeds seeds = random_start(samples, 40, 1);
  for (int n = 0; n < 5; ++n) seeds.positions.push_back(seeds.positions[static_cast<std::size_t>(n)]);  // twins
  for (int n = 0; n < 5; ++n) seeds.positions.push_back({40.0 + n, 30, 20});  // far away, nearest to nothing
  optimize(evaluator, seeds, {.evaluations = 30}, context);
  for (const Vec3& s : seeds.positions) EXPECT_TRUE(is_finite(s));
}

TEST(Optimize, CancelStopsIt) {
  const SampleSet samples = sampled(make_icosphere(2), 24);
  evenmesh::ExecutionContext context(1);
  CpuCellEvaluator evaluator(samples, context);
  Seeds seeds = random_start(samples, 20, 1);
  context.cancel();
  EXPECT_THROW(optimize(evaluator, seeds, {}, context), Cancelled);
}

}  // namespace
}  // namespace evenmesh
