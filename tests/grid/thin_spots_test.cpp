#include "grid/thin_spots.h"

#include <gtest/gtest.h>

#include <cmath>

#include "evenmesh/solid.h"
#include "geometry/primitives.h"
#include "sample/sample.h"

namespace evenmesh {
namespace {

SampleSet sampled(const Shape& shape, const Box& box, std::size_t resolution, unsigned threads = 2) {
  ExecutionContext context(threads);
  return sample_shape(shape, make_grid(box, resolution), context);
}

std::vector<ThinSpot> missed(const SampleSet& samples) {
  std::vector<ThinSpot> spots = wide_spots(samples.thin, samples.grid.origin, samples.grid.spacing);
  std::erase_if(spots, [](const ThinSpot& spot) { return spot.sampled; });
  return spots;
}

Mesh box_between(const Vec3& lo, const Vec3& hi) {
  return make_box_around({lo, hi});
}

/// Turned out of the grid's directions, beside a block that makes the bounds.
Shape tilted_plate(double thickness) {
  Mesh plate = make_box({0.5, 0.5, 0.5 * thickness});
  const Affine turn = Affine::rotate({1, 2, 0.5}, 33);
  for (Vec3& v : plate.vertices) v = turn(v);
  return shape_from_mesh(plate);
}

TEST(ThinSpots, TellThicknessAndAreaOfAWall) {
  constexpr double thickness = 0.004;
  const SampleSet samples = sampled(tilted_plate(thickness), {{-1, -1, -1}, {1, 1, 1}}, 50);
  const ThinParts parts = thin_parts(missed(samples), 0.2);
  EXPECT_NEAR(parts.thickness, thickness, 0.05 * thickness);
  EXPECT_NEAR(parts.least, thickness, 0.05 * thickness);
  EXPECT_NEAR(parts.area, 1, 0.3) << "a tenth is hit by chance, and at the rim it is not wide";
  EXPECT_EQ(parts.parts, 1u);
  EXPECT_FALSE(parts.gaps);
}

TEST(ThinSpots, AreNotWhereRaysGrazeASurface) {
  for (const double radius : {0.2, 0.9}) {
    const Shape ball = shape_from_mesh(make_icosphere(5, radius));
    EXPECT_TRUE(missed(sampled(ball, {{-1, -1, -1}, {1, 1, 1}}, 60)).empty());
  }
  EXPECT_TRUE(missed(sampled(shape_from_mesh(make_torus()), {{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}}, 60)).empty());
}

TEST(ThinSpots, AreNotWherePartsTouch) {
  const Mesh boxes = merged(box_between({0, 0, 0}, {1, 1, 0.4}), box_between({0, 0, 0.4}, {1, 1, 0.9}));
  EXPECT_TRUE(missed(sampled(shape_from_mesh(boxes), {{-0.2, -0.2, -0.2}, {1.2, 1.2, 1.2}}, 60)).empty());
}

TEST(ThinSpots, OfBooleansAreThoseOfTheResult) {
  const Box box{{-0.2, -0.2, -0.2}, {2.2, 1.2, 1.2}};
  const Shape left = shape_from_box({{0, 0, 0}, {1.01, 1, 1}}), right = shape_from_box({{1.013, 0, 0}, {2, 1, 1}});
  const ThinParts gap = thin_parts(missed(sampled(unite({left, right}), box, 101)), 0.2);
  EXPECT_TRUE(gap.gaps);
  EXPECT_NEAR(gap.thickness, 0.003, 1e-4);
  EXPECT_NEAR(gap.area, 1, 0.2);
  const Shape hole = shape_from_box({{0.003, 0.1, 0.1}, {0.9, 0.9, 0.9}});
  const ThinParts wall = thin_parts(missed(sampled(subtract(left, {hole}), box, 101)), 0.2);
  EXPECT_FALSE(wall.gaps);
  EXPECT_NEAR(wall.thickness, 0.003, 1e-4);
  EXPECT_NEAR(wall.area, 0.64, 0.2);
  // The same gap within a third body is none.
  const Shape around = shape_from_box({{-0.1, -0.1, -0.1}, {2.1, 1.1, 1.1}});
  EXPECT_TRUE(missed(sampled(unite({unite({left, right}), around}), box, 101)).empty());
}

TEST(ThinSpots, AreTheSameForAnyNumberOfThreads) {
  const auto spots = [](unsigned threads) {
    return sampled(tilted_plate(0.004), {{-1, -1, -1}, {1, 1, 1}}, 50, threads).thin;
  };
  const std::vector<ThinSpot> one = spots(1), seven = spots(7);
  ASSERT_EQ(one.size(), seven.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].place, seven[i].place);
}

}  // namespace
}  // namespace evenmesh
