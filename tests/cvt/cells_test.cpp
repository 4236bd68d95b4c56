#include "cvt/cells.h"

#include <numbers>

#include "core/instruction_sets.h"
#include "cvt/cvt_testing.h"
#include "grid/density.h"

namespace evenmesh {
namespace {

std::vector<SampleSet> surfaces() {
  std::vector<SampleSet> sets;
  sets.push_back(sampled(make_icosphere(3), 40));
  sets.push_back(sampled(make_torus(), 48));
  sets.push_back(sampled(make_box({1, 0.6, 0.05}), 40));
  sets.push_back(sampled(translated(make_icosphere(2, 1e-3), {50, -20, 7}), 30));  // small, and far from the origin
  return sets;
}

struct TwoNearest {
  double first, second;
};
TwoNearest distances_by_trying_all(const Vec3& p, const std::vector<Vec3>& seeds) {
  TwoNearest d{1e300, 1e300};
  for (const Vec3& s : seeds) {
    const double distance = norm(p - s);
    if (distance < d.first)
      d.second = d.first, d.first = distance;
    else if (distance < d.second)
      d.second = distance;
  }
  return d;
}

/// Labels and pairs against all seeds; single precision may only decide between seeds that are equally near up to
/// rounding.
void expect_nearest(CellEvaluator& evaluator, const std::vector<Vec3>& points, const std::vector<Vec3>& seeds) {
  std::vector<std::uint32_t> labels;
  std::vector<NearestPair> pairs;
  evaluator.nearest(seeds, labels);
  evaluator.nearest_pairs(seeds, pairs);
  ASSERT_EQ(labels.size(), points.size());
  ASSERT_EQ(pairs.size(), points.size());
  const double rounding =
      1e-5 * spacing_of(evaluator.samples(), seeds.size()) + 1e-5 * evaluator.samples().grid.spacing;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_LT(labels[i], seeds.size());
    const TwoNearest expected = distances_by_trying_all(points[i], seeds);
    const auto distance_to = [&](std::uint32_t s) { return norm(points[i] - seeds[s]); };
    wrong += distance_to(labels[i]) > expected.first + rounding;
    wrong += labels[i] != pairs[i].first;
    if (seeds.size() == 1) continue;
    wrong += pairs[i].second == pairs[i].first;
    wrong += distance_to(pairs[i].second) > expected.second + rounding;
  }
  EXPECT_EQ(wrong, 0u) << seeds.size() << " seeds, " << points.size() << " samples";
}

TEST(Cells, MassesAddUpToTheAreaAndCentroidsLieInTheBox) {
  evenmesh::ExecutionContext context(1);
  for (const SampleSet& samples : surfaces()) {
    CpuCellEvaluator evaluator(samples, context);
    const auto seeds = perturbed_seeds(samples, 150, 0, 3);
    CellSums sums;
    evaluator.evaluate(seeds, sums);
    double mass = 0;
    Vec3 moment;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      EXPECT_GE(sums.mass[i], 0);
      mass += sums.mass[i];
      moment += sums.mass[i] * (seeds[i] - samples.grid.origin) + sums.moment[i];
    }
    EXPECT_NEAR(mass, samples.total_area, 1e-5 * samples.total_area);
    EXPECT_GT(sums.energy, 0);
    // However the footprints are cut, the cells' first moments add up to that of the surface.
    Vec3 expected;
    const auto points = positions_of(samples);
    for (std::size_t i = 0; i < points.size(); ++i)
      expected += double(samples.area[i]) * (points[i] - samples.grid.origin);
    EXPECT_LT(norm(moment - expected), 1e-5 * norm(expected));
  }
}

TEST(Cells, EnergyOfOneSeedIsTheSecondMoment) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_icosphere(4), 40);
  CpuCellEvaluator evaluator(samples, context);
  CellSums sums;
  evaluator.evaluate(std::vector<Vec3>{{0, 0, 0}}, sums);
  EXPECT_NEAR(sums.energy, 4 * std::numbers::pi, 0.01 * 4 * std::numbers::pi);  // all at distance 1
  EXPECT_LT(norm(sums.moment[0]), 1e-3 * samples.total_area);
  evaluator.evaluate(std::vector<Vec3>{{0.5, 0, 0}}, sums);
  EXPECT_NEAR(sums.energy, 1.25 * 4 * std::numbers::pi, 0.0125 * 4 * std::numbers::pi);  // parallel axes
  EXPECT_NEAR(sums.moment[0].x, -0.5 * samples.total_area, 0.01 * samples.total_area);
}

TEST(Cells, GradientAgreesWithFiniteDifferences) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_icosphere(4), 64);
  CpuCellEvaluator evaluator(samples, context);
  std::vector<Vec3> seeds = relaxed_seeds(samples, 60);
  const double spacing = spacing_of(samples, seeds.size()), step = 0.01 * spacing;
  Random random(5);
  const auto random_vector = [&] {
    const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
    return Vec3{x, y, z};
  };
  for (Vec3& s : seeds) s += 0.1 * spacing * random_vector();
  CellSums sums, ahead, behind;
  evaluator.evaluate(seeds, sums);
  double scale = 0;
  for (const Vec3& m : sums.moment) scale += squared_norm(2.0 * m);
  scale = std::sqrt(scale);
  for (int trial = 0; trial < 12; ++trial) {
    std::vector<Vec3> direction(seeds.size()), plus = seeds, minus = seeds;
    double expected = 0, length = 0;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      // In half of the trials along the gradient, and a random direction on top.
      direction[i] =
          (trial % 2 == 0 ? -2.0 / scale * std::sqrt(double(seeds.size())) : 0.0) * sums.moment[i] + random_vector();
      expected += dot(-2.0 * sums.moment[i], direction[i]);
      length += squared_norm(direction[i]);
      plus[i] += step * direction[i], minus[i] -= step * direction[i];
    }
    evaluator.evaluate(plus, ahead);
    evaluator.evaluate(minus, behind);
    EXPECT_NEAR((ahead.energy - behind.energy) / (2 * step), expected, 0.01 * scale * std::sqrt(length));
  }
}

TEST(Cells, NearestSeedsAreThoseOfTryingAll) {
  evenmesh::ExecutionContext context(2);
  for (const SampleSet& samples : surfaces()) {
    const auto points = positions_of(samples);
    for (const std::size_t count : {1u, 2u, 3u, 7u, 60u, 400u}) {
      CpuCellEvaluator evaluator(samples, context);
      const double spacing = spacing_of(samples, count);
      expect_nearest(evaluator, points, perturbed_seeds(samples, count, 0.05 * spacing, count));
      expect_nearest(evaluator, points, perturbed_seeds(samples, count, 2 * spacing, count));  // far from the surface
    }
  }
}

TEST(Cells, ListsStayCompleteWhileSeedsMove) {
  evenmesh::ExecutionContext context(2);
  const SampleSet samples = sampled(make_torus(), 40);
  const auto points = positions_of(samples);
  CpuCellEvaluator evaluator(samples, context);
  std::vector<Vec3> seeds = random_start(samples, 120, 1);
  const double spacing = spacing_of(samples, seeds.size());
  Random random(11);
  // Steps from none to several cells; small ones after large ones make lists with a margin and use it up.
  for (const double step :
       {0.0, 0.01, 0.01, 0.02, 0.05, 0.002, 0.04, 0.1, 0.03, 0.5, 0.02, 0.02, 0.02, 3.0, 0.01, 0.0, 0.07, 0.07}) {
    const bool one_only = random.below(3) == 0;
    const std::size_t chosen = random.below(seeds.size());
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
      if (!one_only || i == chosen) seeds[i] += step * spacing * Vec3{x, y, z};
    }
    expect_nearest(evaluator, points, seeds);
  }
  seeds.resize(50);
  expect_nearest(evaluator, points, seeds);
}

TEST(Cells, EquallyNearSeedsGiveTheLowerIndex) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_icosphere(3), 32);
  CpuCellEvaluator evaluator(samples, context);
  std::vector<Vec3> seeds = random_start(samples, 40, 2);
  const std::size_t half = seeds.size();
  for (std::size_t i = 0; i < half; ++i) seeds.push_back(seeds[i]);
  std::vector<std::uint32_t> labels;
  std::vector<NearestPair> pairs;
  evaluator.nearest(seeds, labels);
  evaluator.nearest_pairs(seeds, pairs);
  CellSums sums;
  evaluator.evaluate(seeds, sums);
  double mass = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    ASSERT_LT(labels[i], half);
    ASSERT_EQ(pairs[i].first, labels[i]);
    ASSERT_EQ(pairs[i].second, labels[i] + half);
    ASSERT_NEAR(pairs[i].bisector_distance, 0, 1e-3);
  }
  for (const double m : sums.mass) {
    ASSERT_TRUE(std::isfinite(m));
    mass += m;
  }
  EXPECT_NEAR(mass, samples.total_area, 1e-5 * samples.total_area);
}

TEST(Cells, BisectorDistanceIsThatOfThePlane) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_torus(), 32);
  CpuCellEvaluator evaluator(samples, context);
  const auto seeds = random_start(samples, 90, 4);
  std::vector<NearestPair> pairs;
  evaluator.nearest_pairs(seeds, pairs);
  const auto points = positions_of(samples);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 a = seeds[pairs[i].first], b = seeds[pairs[i].second];
    if (norm(b - a) < samples.grid.spacing) continue;
    const double distance = dot(0.5 * (a + b) - points[i], normalized(b - a));
    ASSERT_NEAR(pairs[i].bisector_distance, distance, 1e-4);
  }
}

TEST(Cells, SameBitsForAnyNumberOfThreads) {
  const SampleSet samples = sampled(make_torus(), 64);
  const auto seeds = random_start(samples, 300, 9);
  std::vector<CellSums> sums(3);
  std::vector<std::vector<std::uint32_t>> labels(3);
  for (unsigned t = 0; t < 3; ++t) {
    evenmesh::ExecutionContext context(t + 1);
    CpuCellEvaluator evaluator(samples, context);
    with_threads(context, [&] {
      evaluator.evaluate(seeds, sums[t]);
      evaluator.nearest(seeds, labels[t]);
    });
  }
  for (unsigned t = 1; t < 3; ++t) {
    EXPECT_TRUE(same_bytes(sums[t].mass, sums[0].mass));
    EXPECT_TRUE(same_bytes(sums[t].moment, sums[0].moment));
    EXPECT_EQ(sums[t].energy, sums[0].energy);
    EXPECT_EQ(labels[t], labels[0]);
  }
}

/// Also that none reads behind an array: numbers of samples and seeds that fill no vector.
TEST(Cells, SameBitsOnEveryInstructionSet) {
  for (const SampleSet& samples : surfaces())
    for (const std::size_t count : {1u, 7u, 300u, 2001u}) {
      evenmesh::ExecutionContext context(1);
      const auto seeds = random_start(samples, std::min(count, samples.size()), 9);
      const auto evaluate = [&](CellSums& sums, std::vector<std::uint32_t>& labels, std::vector<NearestPair>& pairs) {
        CpuCellEvaluator evaluator(samples, context);
        evaluator.evaluate(seeds, sums);
        evaluator.nearest(seeds, labels);
        evaluator.nearest_pairs(seeds, pairs);
      };
      CellSums expected;
      std::vector<std::uint32_t> expected_labels;
      std::vector<NearestPair> expected_pairs;
      evaluate(expected, expected_labels, expected_pairs);
      on_every_instruction_set([&](const char* target) {
        CellSums sums;
        std::vector<std::uint32_t> labels;
        std::vector<NearestPair> pairs;
        evaluate(sums, labels, pairs);
        EXPECT_TRUE(same_bytes(sums.mass, expected.mass)) << target;
        EXPECT_TRUE(same_bytes(sums.moment, expected.moment)) << target;
        EXPECT_EQ(sums.energy, expected.energy) << target;
        EXPECT_EQ(labels, expected_labels) << target;
        EXPECT_TRUE(same_bytes(pairs, expected_pairs)) << target;
      });
    }
}

TEST(Cells, ResultsDoNotDependOnEarlierCalls) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = sampled(make_icosphere(3), 40);
  const auto seeds = random_start(samples, 200, 1);
  CellSums fresh, used;
  CpuCellEvaluator first(samples, context);
  first.evaluate(seeds, fresh);
  CpuCellEvaluator second(samples, context);
  for (int n = 0; n < 3; ++n) second.evaluate(perturbed_seeds(samples, 200, 0.01, 1), used);
  second.evaluate(random_start(samples, 77, 3), used);
  second.evaluate(seeds, used);
  EXPECT_TRUE(same_bytes(fresh.mass, used.mass));
  EXPECT_TRUE(same_bytes(fresh.moment, used.moment));
  EXPECT_EQ(fresh.energy, used.energy);
}

/// Density on a surface, as a set with weights.
SampleSet weighted(const SampleSet& even, const Density& density) {
  evenmesh::ExecutionContext context(1);
  return weigh_by_density(even, density, context).samples;
}

TEST(Cells, MassesAreWeightsAndFootprintsAreAreas) {
  // Weights 256 times as large everywhere: the same cells, cut at the same places, masses and energy 256 times as
  // large.
  evenmesh::ExecutionContext context(1);
  const SampleSet even = sampled(make_torus(), 48);
  SampleSet heavy = even;
  for (const float area : even.area) heavy.weight.push_back(256 * area);
  heavy.total_weight = 256 * even.total_area;
  const auto seeds = perturbed_seeds(even, 150, 0.01, 3);
  CellSums sums, heavy_sums;
  CpuCellEvaluator(even, context).evaluate(seeds, sums);
  CpuCellEvaluator(heavy, context).evaluate(seeds, heavy_sums);
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    ASSERT_EQ(heavy_sums.mass[i], 256 * sums.mass[i]);
    ASSERT_EQ(heavy_sums.moment[i], 256 * sums.moment[i]);
  }
  EXPECT_EQ(heavy_sums.energy, 256 * sums.energy);
}

TEST(Cells, MassesAddUpToTheWeight) {
  evenmesh::ExecutionContext context(1);
  const SampleSet samples = weighted(sampled(make_torus(), 48), [](const Vec3& p) { return 1 + 4 * (p.x > 0); });
  const auto seeds = perturbed_seeds(samples, 150, 0, 3);
  CellSums sums;
  CpuCellEvaluator(samples, context).evaluate(seeds, sums);
  double mass = 0;
  for (const double m : sums.mass) mass += m;
  EXPECT_NEAR(mass, samples.total_weight, 1e-5 * samples.total_weight);
  EXPECT_GT(mass, 1.2 * samples.total_area);
}

TEST(Cells, CancelTakesEffect) {
  const SampleSet samples = sampled(make_icosphere(2), 24);
  evenmesh::ExecutionContext context(1);
  CpuCellEvaluator evaluator(samples, context);
  context.cancel();
  CellSums sums;
  EXPECT_THROW(evaluator.evaluate(random_start(samples, 20, 1), sums), Cancelled);
}

TEST(Cells, EnergyRatioOfAHexagonIsOne) {
  // Second moment of a regular hexagon of area A about its centre: 5·A²/(18·√3).
  const double area = 3.7;
  EXPECT_NEAR(energy_ratio(8 * 5 / (18 * std::sqrt(3.0)) * area * area, 8, 8 * area), 1, 1e-12);
}

}  // namespace
}  // namespace evenmesh
