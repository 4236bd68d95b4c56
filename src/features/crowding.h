#pragma once
/// FeatureCurves that lie too near to each other.

#include <span>
#include <vector>

#include "features/edge_graph.h"
#include "features/feature_curves.h"

namespace evenmesh {

/// Leaves out curves of which a third runs beside other curves, or beside another part of themselves, nearer than
/// `reach` (model units), as around a narrow chamfer; and the corners that are left without a curve. The two rims of a
/// thin part stay: between them it has nothing but its thickness, and is as much smaller as they are missing.
/// @param nodes    of the feature graph that the curves go through
/// @param spacing  of its grid, model units
FeatureCurves without_crowded(const FeatureCurves& features, std::span<const FeatureNode> nodes, double spacing,
                              double reach);

/// Leaves out curves that run along others within `reach` (model units) nearly everywhere: the same edge found twice,
/// of which the longest curve stays.
FeatureCurves without_repeated(const FeatureCurves& features, double reach);

/// The feature curves but for the marked ones, which are left out, and without corners where none ends any more. @param
/// doomed  by curve
FeatureCurves without_curves(const FeatureCurves& features, const std::vector<char>& doomed);

}  // namespace evenmesh
