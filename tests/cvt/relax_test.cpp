#include "cvt/relax.h"

#include "cvt/cvt_testing.h"
#include "geometry/closest_point.h"

namespace evenmesh {
namespace {

TEST(Balance, ConvergedRatioIsNearThatOfHexagons) {
  evenmesh::Run run(2);
  const Mesh meshes[] = {make_icosphere(5), make_torus(1, 0.4, 96, 48), make_box({1, 1, 0.4})};
  for (const Mesh& mesh : meshes) {
    const SampleSet samples = sampled(mesh, 110, 2);
    CellEvaluator evaluator(samples, run);
    const BalanceResult result = balance_seeds(evaluator, 400, {.evaluations = 60}, run);
    EXPECT_LT(result.energy_ratio, 1.03);
    EXPECT_GE(result.energy_ratio, 0.93);  // edges and curvature fold cells, which lowers it a little
  }
}

TEST(Balance, GivesTheCountFromEveryStart) {
  evenmesh::Run run(2);
  const SampleSet samples = sampled(make_torus(), 80, 2);
  const SurfaceQuery surface(make_torus());
  CellEvaluator evaluator(samples, run);
  for (const SeedStart start : {SeedStart::random, SeedStart::blue_noise, SeedStart::coarse_to_fine})
    for (const bool lloyd : {false, true})
      for (const std::size_t count : {4u, 5u, 311u}) {
        const BalanceResult result =
            balance_seeds(evaluator, count, {.start = start, .lloyd = lloyd, .evaluations = 12}, run);
        ASSERT_EQ(result.seeds.size(), count);
        EXPECT_GT(result.energy_ratio, 0);
        if (count < 100) continue;
        for (const Vec3& s : result.seeds) ASSERT_TRUE(surface.closest(s, spacing_of(samples, count)).found());
      }
}

TEST(Balance, ManyLevelsGiveTheCount) {
  evenmesh::Run run(2);
  // 1,500 seeds are two levels; the box has edges, the torus a handle, the pair two bodies.
  const Mesh meshes[] = {make_box({1, 0.5, 0.5}), make_torus(),
                         merged(make_icosphere(3), translated(make_icosphere(3, 0.3), {1.5, 0, 0}))};
  for (const Mesh& mesh : meshes) {
    const SampleSet samples = sampled(mesh, 150, 2);
    CellEvaluator evaluator(samples, run);
    for (const std::size_t count : {1203u, 1500u}) {
      const BalanceResult result = balance_seeds(evaluator, count, {.evaluations = 8}, run);
      EXPECT_EQ(result.seeds.size(), count);
      EXPECT_LT(result.energy_ratio, 1.05);
    }
  }
}

TEST(Balance, SameBitsForAnyNumberOfThreads) {
  const SampleSet samples = sampled(make_torus(), 100, 2);
  std::vector<BalanceResult> results;
  for (unsigned threads = 1; threads <= 3; ++threads) {
    evenmesh::Run run(threads);
    CellEvaluator evaluator(samples, run);
    results.push_back(with_threads(run, [&] { return balance_seeds(evaluator, 1300, {.evaluations = 6}, run); }));
  }
  for (const BalanceResult& result : results) {
    EXPECT_TRUE(same_bytes(result.seeds, results[0].seeds));
    EXPECT_TRUE(same_bytes(result.ratios, results[0].ratios));
  }
}

TEST(Balance, AnnealingDoesNotRaiseTheEnergyMuch) {
  evenmesh::Run run(2);
  const SampleSet samples = sampled(make_icosphere(4), 64, 2);
  CellEvaluator evaluator(samples, run);
  const BalanceOptions plain{.start = SeedStart::random, .evaluations = 30};
  BalanceOptions annealed = plain;
  annealed.annealing_rounds = 4;
  const double before = balance_seeds(evaluator, 100, plain, run).energy_ratio;
  EXPECT_LE(balance_seeds(evaluator, 100, annealed, run).energy_ratio, before * (1 + 1e-9));
}

TEST(Balance, RefusesWhatCannotBeMet) {
  evenmesh::Run run(1);
  const SampleSet samples = sampled(make_icosphere(1), 10);
  CellEvaluator evaluator(samples, run);
  EXPECT_THROW(balance_seeds(evaluator, 3, {}, run), InvalidInput);
  EXPECT_THROW(balance_seeds(evaluator, samples.size() + 1, {}, run), InvalidInput);
  EXPECT_EQ(balance_seeds(evaluator, samples.size() / 4, {.evaluations = 2}, run).seeds.size(), samples.size() / 4);
}

TEST(Balance, CancelStopsIt) {
  const SampleSet samples = sampled(make_icosphere(2), 32);
  evenmesh::Run run(1);
  CellEvaluator evaluator(samples, run);
  run.cancel();
  EXPECT_THROW(balance_seeds(evaluator, 50, {}, run), Cancelled);
}

}  // namespace
}  // namespace evenmesh
