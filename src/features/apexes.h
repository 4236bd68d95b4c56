#pragma once
/// Apexes of cones and the like: points of a surface around which the normal turns, without sharp edges.

#include <span>
#include <vector>

#include "features/edge_graph.h"
#include "features/feature_curves.h"

namespace evenmesh {

/// The points through which all tangent planes up to an edge around go, though they lean by more than `angle` degrees
/// from their mean direction.
///
/// Looked for at the nodes of the graph that lie half an edge or more from the feature curves. Those apexes that are
/// rounded off with a radius of about a grid cell count as sharp.
/// @param edge  mean edge length of the mesh to come, model units
/// Guarantee: same points for any number of threads. Cost: some 50 µs for each of 2,000 places at most; where there are
/// more of them the surface is rough, and has no apexes.
std::vector<Vec3> find_apexes(const SampleSet& samples, std::span<const FeatureNode> nodes,
                              const FeatureCurves& features, double angle, double edge, ExecutionContext& context);

}  // namespace evenmesh
