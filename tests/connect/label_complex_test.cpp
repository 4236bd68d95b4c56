#include "connect/label_complex.h"

#include "connect/connect_testing.h"

namespace evenmesh {
namespace {

/// Enclosed volume, oriented.
double volume_of_triangles(const std::vector<Triangle>& triangles, const std::vector<Vec3>& p) {
  double volume = 0;
  for (const Triangle& t : triangles) volume += dot(p[t[0]], cross(p[t[1]], p[t[2]])) / 6;
  return volume;
}

struct Connected {
  std::vector<std::uint32_t> labels;
  LabelComplex complex;
};

Connected connected(const SampleSet& samples, const std::vector<Vec3>& seeds, unsigned threads = 2) {
  evenmesh::ExecutionContext context(threads);
  Connected c{nearest_labels(samples, seeds), {}};
  c.complex = with_threads(context, [&] { return connect_labels(samples, c.labels, seeds, context); });
  return c;
}

/// What holds for every labelling; true when the complex is a closed mesh of the whole surface.
bool expect_kept_promises(const SampleSet& samples, const std::vector<std::uint32_t>& labels,
                          const std::vector<Vec3>& seeds, const LabelComplex& complex) {
  EXPECT_EQ(complex.labels, seeds.size() + complex.pieces.size());
  for (const std::uint32_t l : labels) EXPECT_LT(l, complex.labels);
  for (std::size_t i = 0; i < complex.pieces.size(); ++i) {
    EXPECT_EQ(complex.pieces[i].new_label, seeds.size() + i);
    EXPECT_GT(complex.pieces[i].area, 0);
  }
  std::size_t degenerate = 0;
  for (const Triangle& t : complex.triangles) {
    degenerate += t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    for (const std::uint32_t l : t) EXPECT_LT(l, complex.labels);
  }
  EXPECT_EQ(degenerate, 0u);
  EXPECT_TRUE(std::is_sorted(complex.defects.begin(), complex.defects.end()));
  EXPECT_EQ(labels.size(), samples.size());
  if (!complex.defects.empty()) return false;
  EXPECT_TRUE(is_closed_manifold(complex.triangles, complex.labels));
  if (unconnected_labels(labels, complex) > 0) return false;
  EXPECT_EQ(euler_of(complex.triangles), complex.surface_euler);
  return true;
}

struct Known {
  const char* name;
  std::size_t resolution, seeds;
  int euler;
};

class LabelComplexOfGallery : public testing::TestWithParam<Known> {};

TEST_P(LabelComplexOfGallery, HasTheTopologyOfTheSolid) {
  const Known known = GetParam();
  const SampleSet samples = sampled_gallery(known.name, known.resolution);
  const auto seeds = blue_noise_start(samples, known.seeds, 1);
  const Connected c = connected(samples, seeds);
  EXPECT_EQ(c.complex.surface_euler, known.euler);
  EXPECT_TRUE(expect_kept_promises(samples, c.labels, seeds, c.complex));
}

INSTANTIATE_TEST_SUITE_P(Gallery, LabelComplexOfGallery,
                         testing::Values(Known{"sphere", 60, 200, 2}, Known{"torus", 80, 300, 0},
                                         Known{"tangle", 90, 900, -8}, Known{"octic-balls", 90, 1500, 54},
                                         Known{"octic", 120, 2500, -54}),
                         [](const auto& of) {
                           std::string name = of.param.name;
                           std::erase(name, '-');
                           return name;
                         });

TEST(LabelComplex, CountsTheHandlesOfASponge) {
  const SampleSet samples = sampled_gallery("menger-2", 60);
  const auto seeds = random_start(samples, 50, 1);
  EXPECT_EQ(connected(samples, seeds).complex.surface_euler, -160);
}

TEST(LabelComplex, IsOrientedOutward) {
  const SampleSet samples = sampled(make_icosphere(4), 50);
  const auto seeds = blue_noise_start(samples, 250, 1);
  const Connected c = connected(samples, seeds);
  ASSERT_TRUE(expect_kept_promises(samples, c.labels, seeds, c.complex));
  EXPECT_NEAR(volume_of_triangles(c.complex.triangles, seeds), 4.0 / 3 * 3.14159265, 0.15);
}

TEST(LabelComplex, SeveralBodiesStaySeveral) {
  const SampleSet samples = sampled(merged(make_icosphere(3), translated(make_icosphere(3, 0.6), {1.9, 0, 0})), 80);
  const auto seeds = blue_noise_start(samples, 300, 1);
  const Connected c = connected(samples, seeds);
  EXPECT_EQ(c.complex.surface_euler, 4);
  EXPECT_TRUE(expect_kept_promises(samples, c.labels, seeds, c.complex));
}

TEST(LabelComplex, FewSeedsAreAManifoldOrTold) {
  const SampleSet sets[] = {sampled(make_torus(), 40), sampled(make_icosphere(3), 30), sampled_gallery("tangle", 40),
                            sampled(make_box({0.5, 0.5, 0.05}), 40)};
  std::size_t good = 0, told = 0;
  for (const SampleSet& samples : sets)
    for (std::uint64_t seed = 1; seed <= 12; ++seed)
      for (const std::size_t count : {1u, 2u, 3u, 5u, 9u, 30u, 80u}) {
        const auto seeds = random_start(samples, count, seed);
        const Connected c = connected(samples, seeds);
        const bool whole = expect_kept_promises(samples, c.labels, seeds, c.complex);
        (whole ? good : told) += 1;
        if (count == 1) {
          EXPECT_FALSE(whole) << "one cell around everything is no disk";
        }
      }
  EXPECT_GT(good, 30u);
  EXPECT_GT(told, 30u);
}

TEST(LabelComplex, RandomLabelsAreAManifoldOrTold) {
  const SampleSet samples = sampled(make_torus(), 24);
  const auto points = positions_of(samples);
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const std::uint32_t count : {2u, 4u, 40u}) {
      const auto seeds = random_start(samples, count, seed);
      Random random(seed);
      std::vector<std::uint32_t> labels(samples.size());
      for (std::size_t i = 0; i < labels.size(); ++i) labels[i] = static_cast<std::uint32_t>(random.below(count));
      evenmesh::ExecutionContext context(2);
      const LabelComplex complex = connect_labels(samples, labels, seeds, context);
      expect_kept_promises(samples, labels, seeds, complex);
      EXPECT_EQ(complex.surface_euler, 0);
    }
}

TEST(LabelComplex, BothSidesOfAThinPlateBecomeCellsOfTheirOwn) {
  const double side = 0.5, half_thickness = 0.02;
  const SampleSet samples = sampled(make_box({side, side, half_thickness}), 80);
  std::vector<Vec3> seeds;  // in the middle of the plate: each is nearest on both sides
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) seeds.push_back({0.2 * i - 0.4, 0.2 * j - 0.4 + 1e-4 * i, 0});
  const Connected c = connected(samples, seeds);
  ASSERT_EQ(c.complex.pieces.size(), 9u) << "cells at the rim hang together around it, the others do not";
  for (const CellComponent& piece : c.complex.pieces) {
    EXPECT_NEAR(piece.area, 0.04, 0.002);
    EXPECT_NEAR(std::abs(piece.centroid.z), half_thickness, 1e-3);
    EXPECT_LT(norm(Vec3{piece.centroid.x, piece.centroid.y, 0} - seeds[piece.label]), 0.01);
  }
  // No label of the inner cells is on both sides any more.
  std::map<std::uint32_t, int> sides;
  const auto points = positions_of(samples);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::abs(points[i].x) < 0.25 && std::abs(points[i].y) < 0.25) sides[c.labels[i]] |= points[i].z > 0 ? 1 : 2;
  EXPECT_EQ(sides.size(), 18u);
  for (const auto& [label, which] : sides) EXPECT_NE(which, 3) << label;
  expect_kept_promises(samples, c.labels, seeds, c.complex);
}

TEST(LabelComplex, TinyPiecesGoToTheirNeighbour) {
  const SampleSet samples = sampled(make_icosphere(4), 50);
  const auto seeds = blue_noise_start(samples, 100, 1);
  const auto labels = nearest_labels(samples, seeds);
  const auto points = positions_of(samples);
  auto speckled = labels;
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (norm(points[i] - seeds[labels[i]]) < samples.grid.spacing) speckled[i] = (labels[i] + 50) % 100;
  ASSERT_NE(speckled, labels);
  evenmesh::ExecutionContext context(2);
  const LabelComplex complex = connect_labels(samples, speckled, seeds, context);
  // Both hand over what nearest() leaves of cells beyond a corner; defects may still name the cells that had holes.
  auto clean = labels;
  auto expected = connect_labels(samples, clean, seeds, context).triangles;
  EXPECT_TRUE(complex.pieces.empty());
  EXPECT_EQ(speckled, clean);
  auto triangles = complex.triangles;
  std::sort(expected.begin(), expected.end());
  std::sort(triangles.begin(), triangles.end());
  EXPECT_EQ(triangles, expected);
}

TEST(LabelComplex, FrayedBordersAreAManifoldOrTold) {
  const SampleSet sets[] = {sampled(make_torus(), 40), sampled_gallery("tangle", 50),
                            sampled(make_box({0.5, 0.5, 0.05}), 40)};
  evenmesh::ExecutionContext context(2);
  std::size_t good = 0;
  for (const SampleSet& samples : sets)
    for (std::uint64_t seed = 1; seed <= 12; ++seed)
      for (const double width : {0.5, 1.0, 2.0}) {
        const auto seeds = blue_noise_start(samples, samples.size() / 60, seed);
        CpuCellEvaluator evaluator(samples, context);
        std::vector<NearestPair> pairs;
        evaluator.nearest_pairs(seeds, pairs);
        std::vector<std::uint32_t> labels(samples.size());
        Random random(seed);
        for (std::size_t i = 0; i < labels.size(); ++i) {
          const bool frayed = pairs[i].bisector_distance < width * samples.grid.spacing && random.below(3) == 0;
          labels[i] = frayed ? pairs[i].second : pairs[i].first;
        }
        const LabelComplex complex = connect_labels(samples, labels, seeds, context);
        good += expect_kept_promises(samples, labels, seeds, complex);
      }
  EXPECT_GT(good, 0u);
}

TEST(LabelComplex, SameBitsForAnyNumberOfThreads) {
  const SampleSet samples = sampled(make_box({0.5, 0.5, 0.03}), 100);
  const auto seeds = random_start(samples, 150, 3);
  const Connected one = connected(samples, seeds, 1);
  for (const unsigned threads : {2u, 3u}) {
    const Connected many = connected(samples, seeds, threads);
    EXPECT_EQ(many.complex.triangles, one.complex.triangles);
    EXPECT_EQ(many.complex.defects, one.complex.defects);
    EXPECT_EQ(many.labels, one.labels);
    ASSERT_EQ(many.complex.pieces.size(), one.complex.pieces.size());
    for (std::size_t i = 0; i < one.complex.pieces.size(); ++i) {
      EXPECT_EQ(many.complex.pieces[i].centroid, one.complex.pieces[i].centroid);
      EXPECT_EQ(many.complex.pieces[i].area, one.complex.pieces[i].area);
    }
  }
}

TEST(LabelComplex, HeldSeedsKeepThePieceTheyLieOn) {
  // A thin plate with one cell that has a small piece above and a large one below.
  evenmesh::ExecutionContext context(2);
  const Shape plate =
      shape_from_expression("max(abs(x), abs(y), 10*abs(z)) - 1", {}, Box{{-1.1, -1.1, -1.1}, {1.1, 1.1, 1.1}});
  const SampleSet samples = sample_shape(plate, make_grid(plate.bounds, 64), context);
  const std::vector<Vec3> seeds{{0, 0, 0.1}, {0.7, 0, 0}, {-0.7, 0, 0}, {0, 0.7, 0}, {0, -0.7, 0}};
  const auto places = positions_of(samples);
  const auto above = [&](std::size_t s) { return places[s].z > 0 && norm(places[s] - seeds[0]) < 0.25; };
  std::vector<std::uint32_t> labels = nearest_labels(samples, seeds);
  for (std::size_t s = 0; s < labels.size(); ++s) {
    const bool below = places[s].z < 0 && std::hypot(places[s].x, places[s].y) < 0.5;
    if (above(s) || below)
      labels[s] = 0;
    else if (labels[s] == 0)
      labels[s] = places[s].x > 0 ? 1 : 2;
  }
  for (const std::size_t fixed : {0u, 1u}) {
    std::vector<std::uint32_t> now = labels;
    const LabelComplex complex = connect_labels(samples, now, {seeds, std::vector<Attachment>(fixed)}, context);
    ASSERT_FALSE(complex.pieces.empty());
    for (std::size_t s = 0; s < now.size(); ++s) EXPECT_TRUE(!above(s) || (now[s] == 0) == (fixed == 1));
  }
}

}  // namespace
}  // namespace evenmesh
