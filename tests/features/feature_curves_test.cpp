#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "connect/connect_testing.h"
#include "cvt/starts.h"
#include "features/apexes.h"
#include "features/crowding.h"
#include "features/feature_seeds.h"
#include "geometry/primitives.h"
#include "shape/expression_field.h"

namespace evenmesh {
namespace {

SampleSet sampled_expression(const std::string& expression, double half, std::size_t resolution = 64) {
  Run run(2);
  const Shape shape = shape_from_expression(expression, {}, {{-half, -half, -half}, {half, half, half}});
  return sample_shape(shape, make_grid(shape.bounds, resolution), run);
}

Creases creases_of(const SampleSet& samples, double edge, unsigned threads = 2) {
  Run run(threads);
  return find_creases(samples, 40, edge, run);
}

TEST(Creases, OfACubeAreItsTwelveEdges) {
  const SampleSet samples = sampled_gallery("cube", 64);
  const Creases creases = creases_of(samples, 0.3);
  EXPECT_EQ(creases.corners.size(), 8u);
  EXPECT_EQ(creases.chains.size(), 12u);
  for (const Vec3& c : creases.corners)
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(std::abs(c[a]), 1, 1e-4);
  for (const CreaseChain& chain : creases.chains) {
    EXPECT_NEAR(chain.length(), 2, 1e-3);
    EXPECT_EQ(chain.points.front(), creases.corners[chain.from]);
    EXPECT_EQ(chain.points.back(), creases.corners[chain.to]);
    for (const Vec3& p : chain.points)
      EXPECT_EQ((std::abs(std::abs(p.x) - 1) < 1e-4) + (std::abs(std::abs(p.y) - 1) < 1e-4) +
                        (std::abs(std::abs(p.z) - 1) < 1e-4) >=
                    2,
                true);
  }
}

TEST(Creases, OfACylinderAreTwoClosedCircles) {
  const Creases creases = creases_of(sampled_expression("max(x^2+y^2-1, abs(z)-0.7)", 1.1), 0.2);
  EXPECT_TRUE(creases.corners.empty());
  ASSERT_EQ(creases.chains.size(), 2u);
  for (const CreaseChain& chain : creases.chains) {
    EXPECT_EQ(chain.from, CreaseChain::none);
    EXPECT_EQ(chain.points.front(), chain.points.back());
    EXPECT_NEAR(chain.length(), 2 * std::numbers::pi, 0.02);
    for (const Vec3& p : chain.points) EXPECT_NEAR(std::hypot(p.x, p.y), 1, 1e-3);
  }
}

TEST(Creases, SmoothAndRoundedSurfacesHaveNone) {
  for (const char* name : {"sphere", "torus", "rounded-box", "octic", "tangle"})
    EXPECT_TRUE(creases_of(sampled_gallery(name, 96), 0.1).chains.empty()) << name;
}

TEST(Creases, OfAPrismMeetAtItsCorners) {
  // A prism over a triangle.
  const Creases creases = creases_of(sampled_expression("max(max(x, y) - 0.8, -x - y - 0.4, abs(z) - 0.6)", 1.5), 0.2);
  EXPECT_EQ(creases.corners.size(), 6u);
  EXPECT_EQ(creases.chains.size(), 9u);
}

TEST(Creases, TipsOfConesAreWhereTheyComeToAPoint) {
  for (const auto& [slope, resolution] : {std::pair{0.3, 128u}, {0.5, 101u}, {0.6, 128u}, {0.6, 140u}, {1.0, 128u}}) {
    const std::string cone = "max(sqrt(x^2+y^2) - " + std::to_string(slope) + "*(0.7-z), -z-0.8)";
    const Creases creases = creases_of(sampled_expression(cone, 1.6, resolution), 0.3);
    EXPECT_EQ(creases.chains.size(), 1u);
    ASSERT_EQ(creases.tips.size(), 1u) << slope;
    EXPECT_LT(norm(creases.tips[0] - Vec3{0, 0, 0.7}), 1e-3) << slope;
  }
  // The same cut off, and rounded off; and a corner of creases.
  for (const char* none : {"max(sqrt(x^2+y^2) - 0.6*(0.7-z), abs(z)-0.4)", "sqrt(x^2+y^2+0.03) - 0.6*(0.7-z)",
                           "max(x+y+z, x-y, y-z) - 0.5"})
    EXPECT_TRUE(creases_of(sampled_expression(none, 1.6, 128), 0.3).tips.empty()) << none;
}

TEST(Tips, AreNotAlongCreasesThatNobodyFollows) {
  evenmesh::Run run(2);
  const SampleSet samples = sampled_gallery("cube", 64);
  const CreaseGraph graph = find_crease_graph(samples, std::cos(0.7), std::cos(0.5), run);
  const std::vector<Vec3> tips = find_tips(samples, graph.nodes, {}, 40, 0.3, run);
  EXPECT_EQ(tips.size(), 8u);
  for (const Vec3& tip : tips)
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(std::abs(tip[a]), 1, 1e-4);
}

TEST(Creases, AreTheSameForAnyNumberOfThreads) {
  const SampleSet samples = sampled_gallery("schwarz-p", 80);
  const Creases one = creases_of(samples, 0.1, 1), two = creases_of(samples, 0.1, 2);
  EXPECT_EQ(one.corners, two.corners);
  ASSERT_EQ(one.chains.size(), two.chains.size());
  EXPECT_GT(one.chains.size(), 0u);
  for (std::size_t c = 0; c < one.chains.size(); ++c) EXPECT_EQ(one.chains[c].points, two.chains[c].points);
}

TEST(CreaseSeeds, AreEvenlySpacedAndNeighboursInTheDual) {
  const SampleSet samples = sampled_gallery("cube", 64);
  const Creases creases = creases_of(samples, 0.26);
  const CreaseSeeds seeds = place_crease_seeds(creases, 0.26);
  EXPECT_EQ(seeds.places.size(), 8u + 12 * 7);
  EXPECT_EQ(seeds.edges.size(), 12u * 8);
  for (const auto& [a, b] : seeds.edges) EXPECT_NEAR(norm(seeds.places[a] - seeds.places[b]), 0.25, 1e-3);

  // Whoever else owns the surface: along the creases the crease's own seeds do.
  const std::vector<Vec3> others = blue_noise_start(samples, 400, 1);
  std::vector<Vec3> all = held_and_others(seeds.places, others, 0, 0.15);
  const Vec3 intruder{1, 0.99, 0.125};
  all.push_back(intruder);
  evenmesh::Run run(2);
  std::vector<std::uint32_t> labels = nearest_labels(samples, all);
  hold_labels(samples, creases, seeds, labels, run);
  const LabelComplex complex = connect_labels(samples, labels, all, run);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : complex.triangles)
    for (int c = 0; c < 3; ++c) edges.insert(std::minmax(t[c], t[(c + 1) % 3]));
  for (const auto& [a, b] : seeds.edges) EXPECT_TRUE(edges.contains(std::minmax(a, b))) << a << " – " << b;
}

TEST(CreaseSeeds, AreDenserWhereTheirChordsWouldLeaveTheCrease) {
  // A slab with rounded corners whose radius is two thirds of an edge.
  const double radius = 0.1, edge = 0.15, straight = 4 * 1.8, round = 2 * std::numbers::pi * radius;
  const SampleSet samples = sampled_expression(
      "max(sqrt(max(abs(x)-0.9,0)^2 + max(abs(y)-0.9,0)^2) + min(max(abs(x),abs(y))-0.9,0) - 0.1, abs(z)-0.3)", 1.1,
      160);
  const Creases creases = creases_of(samples, edge);
  const CreaseSeeds seeds = place_crease_seeds(creases, edge);
  ASSERT_EQ(creases.chains.size(), 2u);
  for (const CreaseChain& chain : creases.chains) {
    EXPECT_EQ(chain.from, CreaseChain::none);
    for (const Vec3& p : chain.points) {
      double nearest = 1;
      for (const auto& [a, b] : seeds.edges) {
        const Vec3 along = seeds.places[b] - seeds.places[a], from = p - seeds.places[a];
        const double share = std::clamp(dot(from, along) / squared_norm(along), 0.0, 1.0);
        nearest = std::min(nearest, norm(from - share * along));
      }
      EXPECT_LE(nearest, crease_deviation * edge);
    }
  }
  EXPECT_LT(double(seeds.places.size()), 2 * (1.2 * straight + 2 * round) / edge) << "but not along the straight sides";
}

}  // namespace
TEST(CreaseChains, LeftOutTakeTheirCornersAlong) {
  Creases creases;
  creases.corners = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  for (const auto& [from, to] : {std::pair{0u, 1u}, std::pair{1u, 2u}, std::pair{2u, 1u}})
    creases.chains.push_back({from, to, {creases.corners[from], creases.corners[to]}, {0, 1}});
  const Creases two = without_chains(creases, {0, 1, 1});
  ASSERT_EQ(two.chains.size(), 1u);
  EXPECT_EQ(two.corners.size(), 2u);
  const Creases rest = without_chains(creases, {1, 0, 0});
  ASSERT_EQ(rest.corners.size(), 2u);
  for (const CreaseChain& chain : rest.chains) {
    EXPECT_EQ(norm(rest.corners[chain.from] - chain.points.front()), 0);
    EXPECT_EQ(norm(rest.corners[chain.to] - chain.points.back()), 0);
  }
}

}  // namespace evenmesh
