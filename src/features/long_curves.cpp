#include "features/long_curves.h"

namespace evenmesh {

FeatureCurves long_curves(const FeatureCurves& features, double least) {
  FeatureCurves kept;
  std::vector<std::uint32_t> corner(features.corners.size(), FeatureCurve::none);
  const auto renumber = [&](std::uint32_t& end) {
    if (end == FeatureCurve::none) return;
    if (corner[end] == FeatureCurve::none) {
      corner[end] = static_cast<std::uint32_t>(kept.corners.size());
      kept.corners.push_back(features.corners[end]);
    }
    end = corner[end];
  };
  for (const FeatureCurve& curve : features.curves) {
    if (curve.length() < least) continue;
    kept.curves.push_back(curve);
    renumber(kept.curves.back().from);
    renumber(kept.curves.back().to);
  }
  return kept;
}

}  // namespace evenmesh
