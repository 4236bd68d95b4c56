#include "cvt/relax.h"

#include "cvt/cvt_testing.h"
#include "geometry/closest_point.h"
#include "grid/density.h"

namespace evenmesh {
namespace {

TEST(Balance, ConvergedRatioIsNearThatOfHexagons) {
  evenmesh::ExecutionContext context(2);
  const Mesh meshes[] = {make_icosphere(5), make_torus(1, 0.4, 96, 48), make_box({1, 1, 0.4})};
  for (const Mesh& mesh : meshes) {
    const SampleSet samples = sampled(mesh, 110, 2);
    CpuCellEvaluator evaluator(samples, context);
    const RelaxResult result = relax_seeds(evaluator, 400, {.evaluations = 60}, context);
    EXPECT_LT(result.energy_ratio, 1.03);
    EXPECT_GE(result.energy_ratio, 0.93);  // edges and curvature fold cells, which lowers it a little
  }
}

TEST(Balance, GivesTheCountFromEveryStart) {
  evenmesh::ExecutionContext context(2);
  const SampleSet samples = sampled(make_torus(), 80, 2);
  const SurfaceQuery surface(make_torus());
  CpuCellEvaluator evaluator(samples, context);
  for (const SeedStart start : {SeedStart::random, SeedStart::blue_noise, SeedStart::coarse_to_fine})
    for (const bool lloyd : {false, true})
      for (const std::size_t count : {4u, 5u, 311u}) {
        const RelaxResult result =
            relax_seeds(evaluator, count, {.start = start, .lloyd = lloyd, .evaluations = 12}, context);
        ASSERT_EQ(result.seeds.size(), count);
        EXPECT_GT(result.energy_ratio, 0);
        if (count < 100) continue;
        for (const Vec3& s : result.seeds.positions)
          ASSERT_TRUE(surface.closest(s, spacing_of(samples, count)).found());
      }
}

TEST(Balance, ManyLevelsGiveTheCount) {
  evenmesh::ExecutionContext context(2);
  // 1,500 seeds are two levels; the box has edges, the torus a handle, the pair two bodies.
  const Mesh meshes[] = {make_box({1, 0.5, 0.5}), make_torus(),
                         merged(make_icosphere(3), translated(make_icosphere(3, 0.3), {1.5, 0, 0}))};
  for (const Mesh& mesh : meshes) {
    const SampleSet samples = sampled(mesh, 150, 2);
    CpuCellEvaluator evaluator(samples, context);
    for (const std::size_t count : {1203u, 1500u}) {
      const RelaxResult result = relax_seeds(evaluator, count, {.evaluations = 8}, context);
      EXPECT_EQ(result.seeds.size(), count);
      EXPECT_LT(result.energy_ratio, 1.05);
    }
  }
}

TEST(Balance, SameBitsForAnyNumberOfThreads) {
  const SampleSet samples = sampled(make_torus(), 100, 2);
  std::vector<RelaxResult> results;
  for (unsigned threads = 1; threads <= 3; ++threads) {
    evenmesh::ExecutionContext context(threads);
    CpuCellEvaluator evaluator(samples, context);
    results.push_back(with_threads(context, [&] { return relax_seeds(evaluator, 1300, {.evaluations = 6}, context); }));
  }
  for (const RelaxResult& result : results) {
    EXPECT_TRUE(same_bytes(result.seeds.positions, results[0].seeds.positions));
    EXPECT_TRUE(same_bytes(result.ratios, results[0].ratios));
  }
}

TEST(Balance, DensityGivesCellsTheirShare) {
  // Four times as many per area at the top of a ball as at the bottom.
  evenmesh::ExecutionContext context(2);
  const SampleSet samples = weigh_by_density(
                                sampled(make_icosphere(5), 110), [](const Vec3& p) { return 5 + 3 * p.z; }, context)
                                .samples;
  CpuCellEvaluator evaluator(samples, context);
  const std::size_t count = 800;
  const RelaxResult result = relax_seeds(evaluator, count, {}, context);
  EXPECT_NEAR(result.energy_ratio, 1, 0.04) << "as without a density";
  std::vector<std::uint32_t> labels;
  evaluator.nearest(result.seeds, labels);
  std::vector<double> share(count, 0);
  for (std::size_t i = 0; i < labels.size(); ++i) share[labels[i]] += samples.share(i);
  const double mean = samples.total_area / double(count);
  double variance = 0;
  for (const double s : share) variance += (s / mean - 1) * (s / mean - 1) / double(count);
  EXPECT_LT(std::sqrt(variance), 0.1);
}

TEST(Balance, AnnealingDoesNotRaiseTheEnergyMuch) {
  evenmesh::ExecutionContext context(2);
  const SampleSet samples = sampled(make_icosphere(4), 64, 2);
  CpuCellEvaluator evaluator(samples, context);
  const RelaxOptions plain{.start = SeedStart::random, .evaluations = 30};
  RelaxOptions annealed = plain;
  annealed.annealing_rounds = 4;
  const double before = relax_seeds(evaluator, 100, plain, context).energy_ratio;
  EXPECT_LE(relax_seeds(evaluator, 100, annealed, context).energy_ratio, before * (1 + 1e-9));
}

TEST(Balance, RefusesWhatCannotBeMet) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_icosphere(1), 10);
  CpuCellEvaluator evaluator(samples, context);
  EXPECT_THROW(relax_seeds(evaluator, 3, {}, context), InvalidInput);
  EXPECT_THROW(relax_seeds(evaluator, samples.size() + 1, {}, context), InvalidInput);
  EXPECT_EQ(relax_seeds(evaluator, samples.size() / 4, {.evaluations = 2}, context).seeds.size(), samples.size() / 4);
}

TEST(Balance, CancelStopsIt) {
  const SampleSet samples = sampled(make_icosphere(2), 32);
  evenmesh::ExecutionContext context(1);
  CpuCellEvaluator evaluator(samples, context);
  context.cancel();
  EXPECT_THROW(relax_seeds(evaluator, 50, {}, context), Cancelled);
}

}  // namespace
}  // namespace evenmesh
