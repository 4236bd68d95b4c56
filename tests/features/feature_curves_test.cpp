#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "connect/connect_testing.h"
#include "cvt/starts.h"
#include "features/apexes.h"
#include "features/crowding.h"
#include "features/feature_seeds.h"
#include "features/followable.h"
#include "geometry/primitives.h"
#include "shape/expression_field.h"

namespace evenmesh {
namespace {

SampleSet sampled_expression(const std::string& expression, double half, std::size_t resolution = 64) {
  ExecutionContext context(2);
  const Shape shape = shape_from_expression(expression, {}, {{-half, -half, -half}, {half, half, half}});
  return sample_shape(shape, make_grid(shape.bounds, resolution), context);
}

FeatureCurves features_of(const SampleSet& samples, double edge, unsigned threads = 2) {
  ExecutionContext context(threads);
  return find_feature_curves(samples, 40, edge, context);
}

TEST(FeatureCurves, OfACubeAreItsTwelveEdges) {
  const SampleSet samples = sampled_gallery("cube", 64);
  const FeatureCurves features = features_of(samples, 0.3);
  EXPECT_EQ(features.corners.size(), 8u);
  EXPECT_EQ(features.curves.size(), 12u);
  for (const Vec3& c : features.corners)
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(std::abs(c[a]), 1, 1e-4);
  for (const FeatureCurve& curve : features.curves) {
    EXPECT_NEAR(curve.length(), 2, 1e-3);
    EXPECT_EQ(curve.points.front(), features.corners[curve.from]);
    EXPECT_EQ(curve.points.back(), features.corners[curve.to]);
    for (const Vec3& p : curve.points)
      EXPECT_EQ((std::abs(std::abs(p.x) - 1) < 1e-4) + (std::abs(std::abs(p.y) - 1) < 1e-4) +
                        (std::abs(std::abs(p.z) - 1) < 1e-4) >=
                    2,
                true);
  }
}

TEST(FeatureCurves, OfACylinderAreTwoClosedCircles) {
  const FeatureCurves features = features_of(sampled_expression("max(x^2+y^2-1, abs(z)-0.7)", 1.1), 0.2);
  EXPECT_TRUE(features.corners.empty());
  ASSERT_EQ(features.curves.size(), 2u);
  for (const FeatureCurve& curve : features.curves) {
    EXPECT_EQ(curve.from, FeatureCurve::none);
    EXPECT_EQ(curve.points.front(), curve.points.back());
    EXPECT_NEAR(curve.length(), 2 * std::numbers::pi, 0.02);
    for (const Vec3& p : curve.points) EXPECT_NEAR(std::hypot(p.x, p.y), 1, 1e-3);
  }
}

TEST(FeatureCurves, BothRimsOfAThinPlateAreFollowed) {
  // A fifth of an edge thick, and four cells.
  const SampleSet samples = sampled_expression("max(abs(x)-1, abs(y)-1, abs(z)-0.0315)", 1.1, 140);
  const FeatureCurves features = features_of(samples, 0.32);
  EXPECT_EQ(features.corners.size(), 8u);
  EXPECT_EQ(features.curves.size(), 12u);
}

TEST(FeatureCurves, OfANarrowChamferNeitherEdgeIsFollowed) {
  const SampleSet samples = sampled_expression("max(abs(x)-1, abs(y)-1, abs(z)-1, x+z-1.9)", 1.1, 100);
  EXPECT_EQ(features_of(samples, 0.3).curves.size(), features_of(samples, 0.5).curves.size() + 2)
      << "0.14 is nearly half of the finer edge, and less than a third of the other";
}

TEST(FeatureCurves, SmoothAndRoundedSurfacesHaveNone) {
  for (const char* name : {"sphere", "torus", "rounded-box", "octic", "tangle"})
    EXPECT_TRUE(features_of(sampled_gallery(name, 96), 0.1).curves.empty()) << name;
}

TEST(FeatureCurves, OfAPrismMeetAtItsCorners) {
  // A prism over a triangle.
  const FeatureCurves features =
      features_of(sampled_expression("max(max(x, y) - 0.8, -x - y - 0.4, abs(z) - 0.6)", 1.5), 0.2);
  EXPECT_EQ(features.corners.size(), 6u);
  EXPECT_EQ(features.curves.size(), 9u);
}

TEST(FeatureCurves, TipsOfConesAreWhereTheyComeToAPoint) {
  for (const auto& [slope, resolution] : {std::pair{0.3, 128u}, {0.5, 101u}, {0.6, 128u}, {0.6, 140u}, {1.0, 128u}}) {
    const std::string cone = "max(sqrt(x^2+y^2) - " + std::to_string(slope) + "*(0.7-z), -z-0.8)";
    const FeatureCurves features = features_of(sampled_expression(cone, 1.6, resolution), 0.3);
    EXPECT_EQ(features.curves.size(), 1u);
    ASSERT_EQ(features.apexes.size(), 1u) << slope;
    EXPECT_LT(norm(features.apexes[0] - Vec3{0, 0, 0.7}), 1e-3) << slope;
  }
  // The same cut off, and rounded off; and a corner of creases.
  for (const char* none : {"max(sqrt(x^2+y^2) - 0.6*(0.7-z), abs(z)-0.4)", "sqrt(x^2+y^2+0.03) - 0.6*(0.7-z)",
                           "max(x+y+z, x-y, y-z) - 0.5"})
    EXPECT_TRUE(features_of(sampled_expression(none, 1.6, 128), 0.3).apexes.empty()) << none;
}

TEST(Tips, AreNotAlongCreasesThatNobodyFollows) {
  evenmesh::ExecutionContext context(2);
  const SampleSet samples = sampled_gallery("cube", 64);
  const FeatureGraph graph = find_feature_graph(samples, 40, context);
  const std::vector<Vec3> apexes = find_apexes(samples, graph.nodes, {}, 40, 0.3, context);
  EXPECT_EQ(apexes.size(), 8u);
  for (const Vec3& apex : apexes)
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(std::abs(apex[a]), 1, 1e-4);
}

TEST(FeatureCurves, AreTheSameForAnyNumberOfThreads) {
  const SampleSet samples = sampled_gallery("schwarz-p", 80);
  const FeatureCurves one = features_of(samples, 0.1, 1), two = features_of(samples, 0.1, 2);
  EXPECT_EQ(one.corners, two.corners);
  ASSERT_EQ(one.curves.size(), two.curves.size());
  EXPECT_GT(one.curves.size(), 0u);
  for (std::size_t c = 0; c < one.curves.size(); ++c) EXPECT_EQ(one.curves[c].points, two.curves[c].points);
}

/// A curve of three points.
FeatureCurve line(std::uint32_t from, std::uint32_t to, const Vec3& a, const Vec3& b) {
  const double length = norm(b - a);
  return {from, to, {a, 0.5 * (a + b), b}, {0, 0.5 * length, length}};
}

TEST(Followable, ShortCurvesGoFirstAndStraightOnesCountTogether) {
  // One line of 20 edges in 20 pieces, and two spurs at every joint, half an edge long.
  FeatureCurves features;
  for (int i = 0; i <= 20; ++i) features.corners.push_back({double(i), 0, 0});
  for (std::uint32_t i = 0; i < 20; ++i)
    features.curves.push_back(line(i, i + 1, features.corners[i], features.corners[i + 1]));
  for (std::uint32_t i = 1; i < 20; ++i)
    for (const double y : {-0.5, 0.5}) {
      const auto tip = static_cast<std::uint32_t>(features.corners.size());
      features.corners.push_back({double(i), y, 0});
      features.curves.push_back(line(i, tip, features.corners[i], features.corners[tip]));
    }
  const FeatureCurves all = followable(features, 1, 100), some = followable(features, 1, 50);
  EXPECT_EQ(all.curves.size(), 58u);
  EXPECT_TRUE(all.left_out.empty());
  EXPECT_EQ(some.curves.size(), 20u);
  EXPECT_EQ(some.corners.size(), 21u);
  ASSERT_EQ(some.left_out.size(), 38u);
  for (const Vec3& p : some.left_out) EXPECT_EQ(std::abs(p.y), 0.25);
  EXPECT_TRUE(followable(features, 1, 10).curves.empty());
}

TEST(FeatureCurves, FoundTwiceCountOnce) {
  FeatureCurves features;
  features.corners = {{0, 0, 0}, {1, 0, 0}};
  features.curves.push_back(line(0, 1, features.corners[0], features.corners[1]));
  features.curves.push_back(line(0, 1, {0, 0.01, 0}, {0.99, 0.01, 0}));
  features.curves.push_back(line(0, 1, {0, 0.5, 0}, {1, 0.5, 0}));
  const FeatureCurves once = without_repeated(features, 0.02);
  ASSERT_EQ(once.curves.size(), 2u);
  EXPECT_EQ(once.curves[0].length(), 1) << "the longest stays";
  EXPECT_TRUE(once.left_out.empty());
}

TEST(FeatureSeeds, AreEvenlySpacedAndNeighboursInTheDual) {
  const SampleSet samples = sampled_gallery("cube", 64);
  const FeatureCurves features = features_of(samples, 0.26);
  const FeatureSeeds seeds = place_feature_seeds(features, 0.26);
  EXPECT_EQ(seeds.seeds.positions.size(), 8u + 12 * 7);
  EXPECT_EQ(seeds.edges.size(), 12u * 8);
  for (const auto& [a, b] : seeds.edges)
    EXPECT_NEAR(norm(seeds.seeds.positions[a] - seeds.seeds.positions[b]), 0.25, 1e-3);

  // Whoever else owns the surface: along the creases the crease's own seeds do.
  const std::vector<Vec3> others = blue_noise_start(samples, 400, 1);
  Seeds all = fixed_and_others(seeds.seeds, others, 0.15);
  const Vec3 intruder{1, 0.99, 0.125};
  all.positions.push_back(intruder);
  evenmesh::ExecutionContext context(2);
  std::vector<std::uint32_t> labels = nearest_labels(samples, all.positions);
  constrain_labels(samples, features, seeds, labels, context);
  const LabelComplex complex = connect_labels(samples, labels, all, context);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : complex.triangles)
    for (int c = 0; c < 3; ++c) edges.insert(std::minmax(t[c], t[(c + 1) % 3]));
  for (const auto& [a, b] : seeds.edges) EXPECT_TRUE(edges.contains(std::minmax(a, b))) << a << " – " << b;
}

TEST(FeatureSeeds, AreDenserWhereTheirChordsWouldLeaveTheCrease) {
  // A slab with rounded corners whose radius is two thirds of an edge.
  const double radius = 0.1, edge = 0.15, straight = 4 * 1.8, round = 2 * std::numbers::pi * radius;
  const SampleSet samples = sampled_expression(
      "max(sqrt(max(abs(x)-0.9,0)^2 + max(abs(y)-0.9,0)^2) + min(max(abs(x),abs(y))-0.9,0) - 0.1, abs(z)-0.3)", 1.1,
      160);
  const FeatureCurves features = features_of(samples, edge);
  const FeatureSeeds seeds = place_feature_seeds(features, edge);
  ASSERT_EQ(features.curves.size(), 2u);
  for (const FeatureCurve& curve : features.curves) {
    EXPECT_EQ(curve.from, FeatureCurve::none);
    for (const Vec3& p : curve.points) {
      double nearest = 1;
      for (const auto& [a, b] : seeds.edges) {
        const Vec3 along = seeds.seeds.positions[b] - seeds.seeds.positions[a], from = p - seeds.seeds.positions[a];
        const double share = std::clamp(dot(from, along) / squared_norm(along), 0.0, 1.0);
        nearest = std::min(nearest, norm(from - share * along));
      }
      EXPECT_LE(nearest, feature_deviation * edge);
    }
  }
  EXPECT_LT(double(seeds.seeds.positions.size()), 2 * (1.2 * straight + 2 * round) / edge)
      << "but not along the straight sides";
}

}  // namespace
TEST(FeatureCurveTest, LeftOutTakeTheirCornersAlong) {
  FeatureCurves features;
  features.corners = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  for (const auto& [from, to] : {std::pair{0u, 1u}, std::pair{1u, 2u}, std::pair{2u, 1u}})
    features.curves.push_back({from, to, {features.corners[from], features.corners[to]}, {0, 1}});
  const FeatureCurves two = without_curves(features, {0, 1, 1});
  ASSERT_EQ(two.curves.size(), 1u);
  EXPECT_EQ(two.corners.size(), 2u);
  const FeatureCurves rest = without_curves(features, {1, 0, 0});
  ASSERT_EQ(rest.corners.size(), 2u);
  for (const FeatureCurve& curve : rest.curves) {
    EXPECT_EQ(norm(rest.corners[curve.from] - curve.points.front()), 0);
    EXPECT_EQ(norm(rest.corners[curve.to] - curve.points.back()), 0);
  }
}

}  // namespace evenmesh
