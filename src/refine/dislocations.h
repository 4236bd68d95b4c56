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
  std::size_t work = 100;       ///< attempts for every irregular vertex, about; 0: none
  double size_weight = 0.2;     ///< μ of smooth_shapes(), at least 0
  double irregular_cost = 0.4;  ///< what an irregular vertex counts beyond the shapes of its triangles, at least 0;
                                ///< those cost about 0.13
  double tolerance = 0.3;       ///< mean edges by which the surface may come off the mesh where it has lain nearer
  std::uint64_t seed = 1;       ///< of the random numbers
};

struct DislocationResult {
  std::size_t irregular_before = 0, irregular = 0;  ///< vertices off the boundary that have not six neighbours
  std::size_t attempts = 0, accepted = 0;
  std::size_t relaxed = 0;      ///< attempts that came to a change of no more irregular vertices
  std::size_t off_surface = 0;  ///< of these, refused since the surface would come off the mesh
};

/// Anneals the connectivity. A pair of vertices with five and seven neighbours is a dislocation of the triangular
/// lattice: flips make it glide, splits of vertices and collapses of edges make it climb, an isolated five or seven
/// takes it in. An attempt is a chain of such edits from one irregular vertex on, each where the last one has left an
/// irregular vertex, until there are no more of them than before (an ejection chain); then the three rings of vertices
/// around come to rest by the energy of smooth_shapes(), on the surface, and what energy and irregular vertices
/// together have gained or lost decides (Metropolis) at a temperature that falls from round to round.
///
/// Refused is what turns a triangle away from its corners by more than 72°, and what takes the mesh away from points of
/// the surface (the vertices and the middles of the triangles that there were), or the middle of a triangle from the
/// surface, by more than `tolerance` unless it was so around there. Vertices where the mesh is sharp (triangles 60° off
/// the normal), feature vertices and the boundary stay where they are; no vertex gets less than four or more than eight
/// neighbours.
///
/// Smooth shapes before, or strain that has nothing to do with an edit decides about it; and after.
/// @param projector  null: vertices stay in their tangent planes
/// Guarantee: as many vertices as before, of which those constrained keep their numbers; the same topology; same bits
/// for any number of threads. Cost: about 0.1 ms for every attempt and core: some 1.5 s for 4,000 vertices, one in
/// seven irregular, where work is 100. Rounds of parts of some 400 vertices run in parallel.
/// @pre  two-manifold, oriented; with or without boundary
DislocationResult remove_dislocations(Mesh& mesh, const Projector* projector, const SizingField& sizing,
                                      const DislocationOptions& options, ExecutionContext& context,
                                      const VertexConstraints& constraints = {});

}  // namespace evenmesh
