#pragma once
/// What of the shape the mesh does not show.

#include <vector>

#include "evenmesh/findings.h"
#include "pipeline/sampling.h"

namespace evenmesh {

struct LostParts {
  std::vector<Finding> findings;
  std::size_t small = 0;  ///< whole pieces of the input that are smaller than a cell of the mesh
};

/// Thin walls and gaps that no sample told of, and of triangle meshes whatever lies farther from the mesh than an edge,
/// but for what lies within the solid. Less than a few cells together is no finding.
/// Cost: about a microsecond for every vertex of the mesh, and 0.3 µs for every triangle of both.
LostParts find_lost_parts(const Sampler& sampler, const Sampling& sampling, const Mesh& mesh,
                          const MeshOptions& options, ExecutionContext& context);

}  // namespace evenmesh
