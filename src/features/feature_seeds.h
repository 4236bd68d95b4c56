#pragma once
/// Seeds on feature curves, and cells that do not reach across.

#include <array>
#include <cstdint>
#include <vector>

#include "features/feature_curves.h"
#include "grid/seeds.h"

namespace evenmesh {

/// Seeds on every corner and evenly spaced along every curve. As labels they are the first ones.
struct FeatureSeeds {
  Seeds seeds;                                 ///< all of them fixed; the corners first, then curve after curve
  std::vector<std::uint32_t> first, segments;  ///< by curve: its first seed between the ends; pieces it is cut into
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< neighbours along a curve

  std::size_t size() const { return seeds.size(); }
};

/// Whether the seeds that place_feature_seeds() would put on a curve follow it: chords within `feature_deviation`.
bool follows(const FeatureCurve& curve, double edge);

/// @param edge  wanted distance between neighbours, model units; curves are cut into equal pieces of about that
FeatureSeeds place_feature_seeds(const FeatureCurves& features, double edge);

/// Seeds on the same curves, twice as near to each other. @param coarse  seeds on `features`
FeatureSeeds halve_spacing(const FeatureCurves& features, const FeatureSeeds& coarse);

/// Gives the samples within one and a half grid cells of a curve to the curve's seed that is nearest along it. With
/// that no other cell reaches across a feature curve, and neighbours along a curve are neighbours in the dual.
///
/// @param seeds  those of `creases`; their labels are 0, 1, …
/// Cost: about a microsecond for every sample near a curve, 5 ns for the others. Same labels for any number of threads.
void constrain_labels(const SampleSet& samples, const FeatureCurves& features, const FeatureSeeds& seeds,
                      std::vector<std::uint32_t>& labels, ExecutionContext& context);

}  // namespace evenmesh
