#pragma once
/// How the triangles of a mesh hang together.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// What is known of a vertex from the triangles and edges around it.
struct VertexState {
  std::uint32_t valence = 0;    ///< edges
  std::uint32_t umbrellas = 0;  ///< groups of its triangles, joined across edges of exactly two triangles
  bool used = false, on_boundary = false, on_non_manifold_edge = false;
};

struct Topology {
  std::vector<VertexState> vertices;
  std::size_t edges = 0;
  /// Edges of one, of three or more, of two triangles that disagree.
  std::size_t boundary = 0, non_manifold = 0, inconsistent = 0;
  std::size_t components = 0;                 ///< connected over edges
  double length_sum = 0, length_squares = 0;  ///< over edges, model units
};

/// Same bits for any number of threads. Cost: some 0.2 µs per triangle and core.
Topology measure_topology(const Mesh& mesh, const ExecutionContext& context = ExecutionContext::silent());

}  // namespace evenmesh
