#include "features/feature_seeds.h"

#include <gtest/gtest.h>

namespace evenmesh {
namespace {

TEST(FeatureSeeds, TwiceAsNearEachOtherOnTheSameCurves) {
  FeatureCurves features;
  features.corners = {{0, 0, 0}, {3, 0, 0}};
  features.curves = {{0, 1, {{0, 0, 0}, {3, 0, 0}}, {0, 3}},
                     {FeatureCurve::none,
                      FeatureCurve::none,
                      {{0, 5, 0}, {1, 5, 0}, {1, 6, 0}, {0, 6, 0}, {0, 5, 0}},
                      {0, 1, 2, 3, 4}}};
  const FeatureSeeds coarse = place_feature_seeds(features, 1), fine = halve_spacing(features, coarse);
  for (std::size_t c = 0; c < 2; ++c) EXPECT_EQ(fine.segments[c], 2 * coarse.segments[c]);
  EXPECT_EQ(fine.edges.size(), 2 * coarse.edges.size());
  EXPECT_EQ(fine.size(), fine.seeds.fixed.size());
  for (const Vec3& p : coarse.seeds.positions)
    EXPECT_NE(std::find(fine.seeds.positions.begin(), fine.seeds.positions.end(), p), fine.seeds.positions.end());
  const FeatureSeeds direct = place_feature_seeds(features, 0.5);
  EXPECT_EQ(fine.seeds.positions, direct.seeds.positions);
}

}  // namespace
}  // namespace evenmesh
