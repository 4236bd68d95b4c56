#include "connect/fragments.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>

#include "connect/connect_testing.h"
#include "grid/blocks.h"

namespace evenmesh {
namespace {

Fragments fragments_of(const SampleSet& samples, const std::vector<Vec3>& seeds, FragmentOptions options = {},
                       unsigned threads = 2) {
  evenmesh::ExecutionContext context(threads);
  return with_threads(context, [&] { return connect_fragments(samples, seeds, options, context); });
}

/// Each triangle once, of three different seeds.
void expect_different_triangles(const std::vector<Triangle>& triangles) {
  std::set<std::array<std::uint32_t, 3>> seen;
  for (const Triangle& t : triangles) {
    std::array<std::uint32_t, 3> corners{t[0], t[1], t[2]};
    std::sort(corners.begin(), corners.end());
    EXPECT_TRUE(corners[0] < corners[1] && corners[1] < corners[2]);
    EXPECT_TRUE(seen.insert(corners).second);
  }
}

double volume_of(const std::vector<Triangle>& triangles, const std::vector<Vec3>& seeds) {
  double volume = 0;
  for (const Triangle& t : triangles) volume += dot(seeds[t[0]], cross(seeds[t[1]], seeds[t[2]])) / 6;
  return volume;
}

/// The paper's definition, every sample against every seed.
std::pair<std::set<SeedEdge>, std::set<SeedEdge>> edges_by_brute_force(const SampleSet& samples,
                                                                       const std::vector<Vec3>& seeds) {
  const double margin = std::numbers::sqrt3 * samples.grid.spacing;
  std::set<SeedEdge> delaunay, candidates;
  for (const Vec3& p : positions_of(samples)) {
    std::vector<std::pair<double, std::uint32_t>> near;
    for (std::uint32_t s = 0; s < seeds.size(); ++s) near.push_back({norm(seeds[s] - p), s});
    std::sort(near.begin(), near.end());
    near.resize(std::min<std::size_t>(near.size(), 3));
    while (near.back().first > near[0].first + margin) near.pop_back();
    if (near.size() < 2 || near.back().first == near[0].first) continue;
    const auto edge = [&](int a, int b) { return SeedEdge(std::minmax(near[a].second, near[b].second)); };
    delaunay.insert(edge(0, 1));
    if (near.size() == 3) candidates.insert(edge(0, 2)), candidates.insert(edge(1, 2));
  }
  for (const SeedEdge& edge : delaunay) candidates.erase(edge);
  return {delaunay, candidates};
}

TEST(Fragments, EdgesAreThoseOfTheDefinition) {
  const SampleSet torus = sampled_gallery("torus", 40), ball = sampled(make_icosphere(3), 30);
  for (const SampleSet* samples : {&torus, &ball})
    for (const std::size_t count : {std::size_t{2}, std::size_t{3}, std::size_t{17}, std::size_t{150}}) {
      const std::vector<Vec3> seeds = perturbed_seeds(*samples, count, 0.02, count);
      const Fragments fragments = fragments_of(*samples, seeds);
      const auto [delaunay, candidates] = edges_by_brute_force(*samples, seeds);
      EXPECT_EQ(fragments.delaunay, std::vector<SeedEdge>(delaunay.begin(), delaunay.end())) << count;
      EXPECT_EQ(fragments.candidates, std::vector<SeedEdge>(candidates.begin(), candidates.end())) << count;
    }
}

TEST(Fragments, SeedsFarFromTheSurfaceAreFound) {
  const SampleSet samples = sampled(make_icosphere(3), 30);
  const std::vector<Vec3> seeds{{90, 0, 0}, {-80, 1, 0}, {0, 70, 3}};
  const auto [delaunay, candidates] = edges_by_brute_force(samples, seeds);
  const Fragments fragments = fragments_of(samples, seeds);
  EXPECT_EQ(fragments.delaunay, std::vector<SeedEdge>(delaunay.begin(), delaunay.end()));
  EXPECT_EQ(fragments.candidates, std::vector<SeedEdge>(candidates.begin(), candidates.end()));
}

TEST(Fragments, FewSeedsGiveNoTriangles) {
  const SampleSet samples = sampled(make_icosphere(2), 30);
  EXPECT_TRUE(fragments_of(samples, {}).complex.triangles.empty());
  EXPECT_TRUE(fragments_of(samples, {{1, 0, 0}}).complex.triangles.empty());
  EXPECT_TRUE(fragments_of(samples, {{1, 0, 0}, {-1, 0, 0}}).complex.triangles.empty());
}

TEST(Fragments, SquaresAreCyclesOfFour) {
  // The corners of a cube on the sphere around it: all cells meet four at a time.
  const SampleSet samples = sampled(make_icosphere(5), 61);
  std::vector<Vec3> seeds;
  for (int c = 0; c < 8; ++c) seeds.push_back(normalized({c & 1 ? 1.0 : -1.0, c & 2 ? 1.0 : -1.0, c & 4 ? 1.0 : -1.0}));
  const Fragments none = fragments_of(samples, seeds, {.max_cycle = 3});
  EXPECT_EQ(none.delaunay.size(), 12u);
  EXPECT_TRUE(none.complex.triangles.empty());
  EXPECT_EQ(none.complex.defects, none.delaunay);
  for (const std::size_t longest : {4u, 5u, 8u}) {
    const Fragments fragments = fragments_of(samples, seeds, {.max_cycle = longest});
    EXPECT_EQ(fragments.complex.triangles.size(), 12u);
    EXPECT_TRUE(fragments.complex.defects.empty());
    EXPECT_TRUE(is_closed_manifold(fragments.complex.triangles, seeds.size()));
    EXPECT_EQ(fragments.complex.edges_by_cycle[0], 0u);
    EXPECT_EQ(fragments.complex.edges_by_cycle[1], 18u);
    EXPECT_GT(volume_of(fragments.complex.triangles, seeds), 0);
  }
}

TEST(Fragments, PentagonsAreCyclesOfFive) {
  // The corners of a dodecahedron.
  const double phi = std::numbers::phi, inverse = 1 / phi;
  std::vector<Vec3> seeds;
  for (int c = 0; c < 8; ++c) seeds.push_back({c & 1 ? 1.0 : -1.0, c & 2 ? 1.0 : -1.0, c & 4 ? 1.0 : -1.0});
  for (const double s : {-inverse, inverse})
    for (const double t : {-phi, phi})
      seeds.push_back({0, s, t}), seeds.push_back({s, t, 0}), seeds.push_back({t, 0, s});
  for (Vec3& s : seeds) s = normalized(s);
  const SampleSet samples = sampled(make_icosphere(5), 120);
  const Fragments four = fragments_of(samples, seeds, {.max_cycle = 4}), five = fragments_of(samples, seeds);
  EXPECT_TRUE(four.complex.triangles.empty());
  EXPECT_EQ(five.delaunay.size(), 30u);
  EXPECT_EQ(five.complex.triangles.size(), 36u);
  EXPECT_TRUE(five.complex.defects.empty());
  EXPECT_TRUE(is_closed_manifold(five.complex.triangles, seeds.size()));
  EXPECT_EQ(five.complex.edges_by_cycle[2], 54u);
}

TEST(Fragments, AVertexOfThreeTrianglesHasNoLidOverIt) {
  // A seed in the middle of three, and one on the other side: the outer three are a cycle, too.
  const SampleSet samples = sampled(make_icosphere(5), 80);
  std::vector<Vec3> seeds{{0, 0, 1}, {0, 0, -1}};
  for (int i = 0; i < 3; ++i) {
    const double turn = 2 * std::numbers::pi * i / 3;
    seeds.push_back(normalized({std::cos(turn), std::sin(turn), 0.3}));
  }
  const Fragments fragments = fragments_of(samples, seeds);
  EXPECT_EQ(fragments.left_out, 1u);
  EXPECT_EQ(fragments.complex.triangles.size(), 6u);
  EXPECT_TRUE(fragments.complex.defects.empty());
  EXPECT_TRUE(is_closed_manifold(fragments.complex.triangles, seeds.size()));
}

TEST(Fragments, BalancedCellsHaveTheTopologyOfTheSurface) {
  for (const auto& [name, resolution, count] :
       {std::tuple{"torus", 80, 300}, std::tuple{"tangle", 120, 800}, std::tuple{"octic", 150, 2500}}) {
    const SampleSet samples = sampled_gallery(name, static_cast<std::size_t>(resolution));
    const std::vector<Vec3> seeds = relaxed_seeds(samples, static_cast<std::size_t>(count));
    const Fragments fragments = fragments_of(samples, seeds);
    const LabelComplex& complex = fragments.complex;
    expect_different_triangles(complex.triangles);
    EXPECT_TRUE(complex.defects.empty()) << name << ", " << complex.defects.size();
    EXPECT_TRUE(is_closed_manifold(complex.triangles, seeds.size())) << name;
    evenmesh::ExecutionContext context(2);
    std::vector<std::uint32_t> labels = nearest_labels(samples, seeds);
    EXPECT_EQ(euler_of(complex.triangles), connect_labels(samples, labels, seeds, context).surface_euler) << name;
    const auto& edges = complex.edges_by_cycle;
    EXPECT_EQ(2 * std::accumulate(edges.begin(), edges.end(), std::size_t{0}), 3 * complex.triangles.size());
    EXPECT_GT(edges[0], 20 * (edges[1] + edges[2]));
    for (const unsigned threads : {1u, 7u}) {
      const Fragments again = fragments_of(samples, seeds, {}, threads);
      EXPECT_EQ(again.complex.triangles, complex.triangles);
      EXPECT_EQ(again.delaunay, fragments.delaunay);
      EXPECT_EQ(again.candidates, fragments.candidates);
    }
  }
}

TEST(Fragments, NeedNoSolid) {
  // A third of the samples has gone at random: no inside is left, but the cells still meet.
  const SampleSet all = sampled_gallery("torus", 100);
  const std::vector<Vec3> seeds = relaxed_seeds(all, 250);
  Random random(3);
  const SampleSet samples = keep_samples(all, [&](std::uint32_t) { return random.below(3) > 0; });
  const Fragments fragments = fragments_of(samples, seeds);
  EXPECT_TRUE(fragments.complex.defects.empty());
  EXPECT_TRUE(is_closed_manifold(fragments.complex.triangles, seeds.size()));
  EXPECT_EQ(euler_of(fragments.complex.triangles), 0);
  EXPECT_GT(volume_of(fragments.complex.triangles, seeds), 0);
}

TEST(Fragments, OpenSurfacesHaveABoundary) {
  const SampleSet all = sampled(make_icosphere(5), 80);
  const auto points = positions_of(all);
  const SampleSet samples = keep_samples(all, [&](std::uint32_t i) { return points[i].z > 0; });
  const std::vector<Vec3> seeds = relaxed_seeds(samples, 200);
  const Fragments fragments = fragments_of(samples, seeds, {.open = true});
  EXPECT_TRUE(fragments.complex.defects.empty());
  EXPECT_EQ(euler_of(fragments.complex.triangles), 1);
  EXPECT_FALSE(fragments_of(samples, seeds).complex.defects.empty());
  const HalfEdges edges(fragments.complex.triangles, seeds.size());
  for (const Triangle& t : fragments.complex.triangles)
    EXPECT_GT(dot(cross(seeds[t[1]] - seeds[t[0]], seeds[t[2]] - seeds[t[0]]), seeds[t[0]]), 0);
}

}  // namespace
}  // namespace evenmesh
