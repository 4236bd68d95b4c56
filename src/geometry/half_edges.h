#pragma once
/// Who is across an edge: half-edge connectivity of indexed triangles.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Half-edge 3·t + c runs from corner c of triangle t to the next corner.
class HalfEdges {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// Cost: O(triangles), about 30 ns each.
  HalfEdges(std::span<const Triangle> triangles, std::size_t vertices);

  /// The half-edge back along the same edge; none unless exactly two half-edges lie on the edge, in opposite
  /// directions.
  std::uint32_t opposite(std::size_t half_edge) const { return opposite_[half_edge]; }
  /// Some half-edge that starts at the vertex, none if no triangle uses it.
  std::uint32_t outgoing(std::size_t vertex) const { return outgoing_[vertex]; }
  /// Triangles at the vertex.
  std::uint32_t corners(std::size_t vertex) const { return start_[vertex + 1] - start_[vertex]; }
  /// Groups of triangles at the vertex that are connected across edges; 1 on a two-manifold. Needs no boundary at the
  /// vertex.
  std::uint32_t fans(std::size_t vertex) const;

  static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static std::uint32_t previous(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

 private:
  std::vector<std::uint32_t> opposite_, outgoing_, start_, half_edges_from_;
};

}  // namespace evenmesh
