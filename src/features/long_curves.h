#pragma once
/// The long ones of many feature curves.

#include "features/feature_curves.h"

namespace evenmesh {

/// Curves of `least` length and more, and the corners between them; no apexes.
FeatureCurves long_curves(const FeatureCurves& features, double least);

}  // namespace evenmesh
