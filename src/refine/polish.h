#pragma once
/// Last improvement of the few worst triangles.

#include "evenmesh/mesh.h"
#include "refine/projector.h"

namespace evenmesh {

struct PolishOptions {
  double quality = 0.72;  ///< triangles with Q below this are worked on
  int rounds = 12;
};

/// Moves the vertices of bad triangles along the surface so that the worst Q around each of them grows (pattern search, steps
/// of a quarter to a hundredth of the local edge length), then back onto the surface; never folds a triangle over.
///
/// Guarantee: the smallest Q of the mesh does not fall; same bits for any number of threads. Cost: O(bad triangles), plus
/// 20 ns for every triangle. Returns the number of vertices moved.
std::size_t polish(Mesh& mesh, const Projector* projector, const PolishOptions& options, Run& run);

}  // namespace evenmesh
