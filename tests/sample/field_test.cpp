#include <gtest/gtest.h>

#include <numbers>

#include "evenmesh/error.h"
#include "sample_checks.h"
#include "test_fields.h"

namespace evenmesh {
namespace {

constexpr double pi = std::numbers::pi;

double torus(double x, double y, double z) {
  const double ring = std::sqrt(x * x + y * y) - 1;
  return ring * ring + z * z - 0.35 * 0.35;
}

SampleSet sampled(const Shape& shape, std::size_t resolution, unsigned threads = 1) {
  evenmesh::Run run(threads);
  return sample_shape(shape, make_grid(shape.bounds, resolution), run);
}

Shape ball() {
  return {"ball", {{-1.1, -1.1, -1.1}, {1.1, 1.1, 1.1}}, std::make_shared<const BallField>(), false};
}

TEST(SampleField, BallIsExact) {
  const SampleSet set = sampled(ball(), 90);
  expect_well_formed(set);
  const std::vector<bool> inside = expect_one_sign_grid(set);
  EXPECT_NEAR(volume_of(set, inside), 4 * pi / 3, 0.01 * 4 * pi / 3);
  EXPECT_NEAR(set.total_area, 4 * pi, 0.01 * 4 * pi);
  EXPECT_FALSE(set.cut_by_bounds);
  EXPECT_TRUE(set.source.empty());
  for (const SampleBlock& b : set.blocks)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      const Vec3 p = position(set, b, i);
      EXPECT_NEAR(norm(p), 1, 2e-4 * set.grid.spacing);
      EXPECT_GT(dot(unpack_normal(set.normal[i]), normalized(p)), 1 - 1e-5);
    }
}

TEST(SampleField, PruningChangesNothing) {
  const auto f = [](double x, double y, double z) {
    const auto u = static_cast<float>(x), v = static_cast<float>(y), w = static_cast<float>(z);
    return u * u + v * v + w * w - 1.0f;
  };
  const SampleSet pruned = sampled(ball(), 70), all = sampled(field_shape(f, ball().bounds), 70);
  EXPECT_TRUE(same_bytes(pruned.edge, all.edge));
}

TEST(SampleField, TorusAndItsThreads) {
  const Shape shape = field_shape(torus, {{-1.4, -1.4, -0.4}, {1.4, 1.4, 0.4}});
  const SampleSet set = sampled(shape, 100);
  expect_well_formed(set);
  const std::vector<bool> inside = expect_one_sign_grid(set);
  EXPECT_NEAR(set.total_area, 4 * pi * pi * 0.35, 0.01 * 4 * pi * pi * 0.35);
  EXPECT_NEAR(volume_of(set, inside), 2 * pi * pi * 0.35 * 0.35, 0.05);
  expect_same(set, sampled(shape, 100, 2));
}

// Values that say little about the root: kinks, jumps, infinities, steep and flat sides.
TEST(SampleField, RootsOfAwkwardFunctions) {
  const auto steep = [](double x, double y, double z) {
    return std::exp(40 * (std::sqrt(x * x + y * y + z * z) - 1)) - 1;
  };
  const auto kinked = [](double x, double y, double z) {
    const double d = std::sqrt(x * x + y * y + z * z) - 1;
    return d < 0 ? 1000 * d : d;
  };
  const auto jumping = [](double x, double y, double z) { return x * x + y * y + z * z < 1 ? -1000.0 : 1e-3; };
  const auto infinite = [](double x, double y, double z) {
    const double d = x * x + y * y + z * z - 1;
    return d < 0 ? d : std::numeric_limits<double>::infinity();
  };
  const auto undefined = [](double x, double y, double z) { return -std::sqrt(1 - x * x - y * y - z * z); };
  const Box box{{-1.1, -1.2, -1.3}, {1.1, 1.2, 1.3}};
  for (const Shape& shape : {field_shape(steep, box), field_shape(kinked, box), field_shape(jumping, box),
                             field_shape(infinite, box), field_shape(undefined, box)}) {
    const SampleSet set = sampled(shape, 40);
    expect_one_sign_grid(set);
    double worst = 0;
    for (const SampleBlock& b : set.blocks)
      for (std::size_t i = b.begin; i < b.end; ++i) worst = std::max(worst, std::abs(norm(position(set, b, i)) - 1));
    EXPECT_LT(worst, 1e-3 * set.grid.spacing);
  }
}

TEST(SampleField, BoundsCapTheSolid) {
  const auto tube = [](double x, double y, double) { return x * x + y * y - 0.25; };
  const Shape shape = field_shape(tube, {{-1, -1, -0.7}, {1, 1, 0.8}});
  const SampleSet set = sampled(shape, 80);
  expect_well_formed(set);
  const std::vector<bool> inside = expect_one_sign_grid(set);
  EXPECT_TRUE(set.cut_by_bounds);
  EXPECT_NEAR(volume_of(set, inside), pi * 0.25 * 1.5, 0.04 * pi * 0.25 * 1.5);
  EXPECT_NEAR(set.total_area, 2 * pi * 0.5 * 1.5 + 2 * pi * 0.25, 0.01 * 2 * pi);
  for (const SampleBlock& b : set.blocks)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      const Vec3 p = position(set, b, i);
      EXPECT_LT(p.z, 0.8 + 1e-5);
      EXPECT_GT(p.z, -0.7 - 1e-5);
    }
}

TEST(SampleField, FullBoundsAreABox) {
  const Shape shape = field_shape([](double, double, double) { return -1.0; }, {{0, 0, 0}, {1, 0.5, 0.25}});
  const SampleSet set = sampled(shape, 50);
  expect_well_formed(set);
  expect_one_sign_grid(set);
  EXPECT_TRUE(set.cut_by_bounds);
  EXPECT_NEAR(set.total_area, 2 * (0.5 + 0.25 + 0.125), 0.05);
}

TEST(SampleField, FittedBoundsAreNoCut) {
  const auto cube = [](double x, double y, double z) {
    return std::max({std::abs(x) - 1, std::abs(y) - 0.7, std::abs(z) - 0.5});
  };
  const SampleSet set = sampled(field_shape(cube, {{-1, -0.7, -0.5}, {1, 0.7, 0.5}}), 60);
  expect_well_formed(set);
  expect_one_sign_grid(set);
  EXPECT_FALSE(set.cut_by_bounds);
  EXPECT_NEAR(set.total_area, 4 * 2 * (0.7 + 0.5 + 0.35), 0.4);
}

TEST(SampleField, IndicatorsGetNormalsFromTheirNeighbours) {
  const auto f = [](double x, double y, double z) { return torus(x, y, z) < 0 ? -1.0 : 1.0; };
  const Shape shape = field_shape(f, {{-1.4, -1.4, -0.4}, {1.4, 1.4, 0.4}}, false);
  const SampleSet set = sampled(shape, 80);
  expect_one_sign_grid(set);
  EXPECT_NEAR(set.total_area, 4 * pi * pi * 0.35, 0.015 * 4 * pi * pi * 0.35);
  double worst = 1, sum = 0;
  for (const SampleBlock& b : set.blocks)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      const Vec3 p = position(set, b, i);
      const double r = std::hypot(p.x, p.y);
      const Vec3 exact = normalized({p.x - p.x / r, p.y - p.y / r, p.z});
      EXPECT_NEAR(std::hypot(r - 1, p.z), 0.35, 1e-3 * set.grid.spacing);
      const double c = dot(exact, unpack_normal(set.normal[i]));
      worst = std::min(worst, c), sum += c;
    }
  EXPECT_GT(worst, 0.97);
  EXPECT_GT(sum / double(set.size()), 0.9995);
  expect_same(set, sampled(shape, 80, 2));
}

TEST(SampleField, NothingInsideIsSaid) {
  EXPECT_THROW(sampled(field_shape([](double, double, double) { return 1.0; }, {{0, 0, 0}, {1, 1, 1}}), 20),
               UnusableInput);
  EXPECT_THROW(sampled(field_shape([](double, double, double) { return std::nan(""); }, {{0, 0, 0}, {1, 1, 1}}), 20),
               UnusableInput);
}

TEST(SampleField, CancelStops) {
  evenmesh::Run run;
  run.cancel();
  EXPECT_THROW(sample_shape(ball(), make_grid(ball().bounds, 50), run), Cancelled);
}

}  // namespace
}  // namespace evenmesh
