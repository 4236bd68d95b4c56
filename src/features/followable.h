#pragma once
/// Which feature curves a mesh can follow.

#include <cstddef>

#include "features/feature_curves.h"

namespace evenmesh {

/// The curves without the shortest ones where seeds on all would be too many, or where they form a web as fine as the
/// mesh: then all up to one length, an edge or more, are left out, until the rest is half as many, and half as dense,
/// as the limit. Curves that go straight on beyond a corner count together. Where nothing remains, apexes go, too.
/// @param edge  mean edge length of the mesh to come, model units
/// @param most  seeds on curves
FeatureCurves followable(const FeatureCurves& features, double edge, std::size_t most);

}  // namespace evenmesh
