#pragma once
/// The paths of a feature graph from junction to junction.

#include <vector>

#include "features/edge_graph.h"
#include "features/polyline.h"

namespace evenmesh {

struct FeaturePath {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t from = none, to = none;  ///< junctions; none: a closed path, whose last point is its first
  std::vector<PolylinePoint> points;     ///< first and last at the junctions
};

struct FeatureNetwork {
  std::vector<Vec3> junctions;  ///< where paths begin, end or meet
  std::vector<FeaturePath> paths;
  std::vector<Vec3> left_out;  ///< one place on each path that is too short, though no noise
};

/// Follows the sharp links, and the weak ones that continue them, and cleans what comes out: no branches and loops too
/// small to be seen, no junctions next to each other, none where only two paths meet, no small parts.
/// @param origin  of the grid that the graph is of, and its spacing; model units
/// @param edge    mean edge length of the mesh to come, model units
FeatureNetwork find_feature_network(const FeatureGraph& graph, const Vec3& origin, double spacing, double edge);

}  // namespace evenmesh
