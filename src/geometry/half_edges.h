#pragma once
/// Who is across an edge: half-edge connectivity of indexed triangles.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// Half-edge 3·t + c runs from corner c of triangle t to the next corner.
class HalfEdges {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// Same result for any number of threads. Cost: O(triangles), about 30 ns each and core.
  HalfEdges(std::span<const Triangle> triangles, std::size_t vertices,
            const ExecutionContext& context = ExecutionContext::silent());

  /// The half-edge back along the same edge; none unless exactly two half-edges lie on the edge, in opposite
  /// directions.
  std::uint32_t opposite(std::size_t half_edge) const { return opposite_[half_edge]; }
  /// Some half-edge that starts at the vertex, none if no triangle uses it.
  std::uint32_t outgoing(std::size_t vertex) const { return outgoing_[vertex]; }
  /// Triangles at the vertex.
  std::uint32_t corners(std::size_t vertex) const { return start_[vertex + 1] - start_[vertex]; }
  /// Groups of triangles at the vertex that are connected across edges; 1 on a two-manifold.
  std::uint32_t umbrellas(std::size_t vertex) const;
  /// Calls visit(half-edge, fan) for all half-edges that start at the vertex, fan by fan.
  template <typename Visit>
  void visit_umbrellas(std::size_t vertex, const Visit& visit) const {
    std::vector<std::uint32_t> visited;
    std::uint32_t umbrella = 0;
    for (std::uint32_t at = start_[vertex]; at < start_[vertex + 1]; ++at) {
      if (std::find(visited.begin(), visited.end(), half_edges_from_[at]) != visited.end()) continue;
      // Back to where the fan begins, on a boundary, or once around.
      std::uint32_t first = half_edges_from_[at];
      while (opposite_[first] != none && (first = next(opposite_[first])) != half_edges_from_[at]) {
      }
      std::uint32_t h = first;
      do {
        visited.push_back(h);
        visit(h, umbrella);
        h = opposite_[previous(h)];
      } while (h != none && h != first);
      ++umbrella;
    }
  }

  static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static std::uint32_t previous(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

 private:
  void pair_half_edges_at(std::uint32_t v, std::span<const Triangle> triangles);

  std::vector<std::uint32_t> opposite_, outgoing_, start_, half_edges_from_;
};

}  // namespace evenmesh
