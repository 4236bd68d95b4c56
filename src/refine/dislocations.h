#pragma once
/// Fewer irregular vertices: dislocations move, meet and vanish.

#include <cstddef>
#include <cstdint>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "grid/sizing_field.h"
#include "refine/vertex_constraints.h"
#include "sample/projector.h"

namespace evenmesh {

struct DislocationOptions {
  std::size_t work = 100;       ///< chains tried for every irregular vertex, about
  double size_weight = 0.2;     ///< μ of smooth_shapes(), at least 0
  double irregular_cost = 0.2;  ///< energy that an irregular vertex counts beyond that of the shapes around it
  double temperature = 0.1;     ///< energy by which changes to the worse are accepted at first
  double last_temperature = 0.01;
  double tolerance = 0.1;  ///< share of an edge that the surface may lie off anyway
  std::uint64_t seed = 1;
  int rounds = 12, longest_chain = 8;
  double climb_share = 0.3, count_cost = 0.02;
};

struct DislocationResult {
  std::size_t irregular_before = 0, irregular = 0;  ///< vertices within the surface that have not six edges
  std::size_t attempts = 0, relaxed = 0, finished = 0, bent = 0, accepted = 0;
};

DislocationResult remove_dislocations(Mesh& mesh, const Projector* projector, const SizingField& sizing,
                                      const DislocationOptions& options, ExecutionContext& context,
                                      const VertexConstraints& constraints = {});

}  // namespace evenmesh
