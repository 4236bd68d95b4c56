#pragma once
/// The corners of triangles by vertex.

#include <span>

#include "core/grouping.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// Corners 3 · triangle + corner by the vertex they lie at, ascending. Same result for any number of threads.
inline Groups corners_by_vertex(std::span<const Triangle> triangles, std::size_t vertices,
                                const ExecutionContext& context) {
  static_assert(sizeof(Triangle) == 3 * sizeof(std::uint32_t));
  const auto* vertex_of = reinterpret_cast<const std::uint32_t*>(triangles.data());  // spares divisions by three
  return group_by_key(context, 3 * triangles.size(), vertices, [=](std::size_t corner) { return vertex_of[corner]; });
}

}  // namespace evenmesh
