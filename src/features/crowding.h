#pragma once
/// FeatureCurves that lie too near to each other.

#include "features/feature_curves.h"

namespace evenmesh {

/// Leaves out chains of which a third runs beside other chains, or beside another part of themselves, nearer than
/// `reach` (model units), as around a thin plate; and the corners that are left without a chain.
FeatureCurves without_crowded(const FeatureCurves& features, double reach);

/// The creases but for the marked chains, and without corners where none ends any more. @param doomed  by chain
FeatureCurves without_curves(const FeatureCurves& features, const std::vector<char>& doomed);

}  // namespace evenmesh
