#pragma once
/// FeatureCurves that lie too near to each other.

#include "features/feature_curves.h"

namespace evenmesh {

/// Leaves out curves of which a third runs beside other curves, or beside another part of themselves, nearer than
/// `reach` (model units), as around a thin plate; and the corners that are left without a curve.
FeatureCurves without_crowded(const FeatureCurves& features, double reach);

/// Leaves out curves that run along others within `reach` (model units) nearly everywhere: the same edge found twice,
/// of which the longest curve stays.
FeatureCurves without_repeated(const FeatureCurves& features, double reach);

/// The feature curves but for the marked ones, which are left out, and without corners where none ends any more. @param
/// doomed  by curve
FeatureCurves without_curves(const FeatureCurves& features, const std::vector<char>& doomed);

}  // namespace evenmesh
