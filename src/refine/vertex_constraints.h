#pragma once
/// What refinement must leave as it is: vertices and edges on feature curves.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "evenmesh/execution_context.h"
#include "features/feature_curves.h"

namespace evenmesh {

/// Vertices at corners do not move, those on a feature curve move along it only, edges along it are not flipped.
struct VertexConstraints {
  static constexpr std::uint32_t free = 0xffffffffu, corner = 0xfffffffeu;

  std::vector<std::uint32_t> curve;  ///< by vertex: free, corner, or the curve it lies on; empty: all are free
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< lower vertex first, sorted
  FeatureCurves features;
  double max_chordal_deviation =
      0;  ///< of a feature curve over an edge along it, model units; beyond that vertices do not move apart

  bool vertex(std::uint32_t v) const { return v < curve.size() && curve[v] != free; }
  bool at_corner(std::uint32_t v) const { return v < curve.size() && curve[v] == corner; }
  bool edge(std::uint32_t a, std::uint32_t b) const;
  /// The point of v's feature curve that is nearest to p. @pre  v is on one
  Vec3 slide(std::uint32_t v, const Vec3& p) const;
  /// How far the feature curve lies from the edges along it that end at v, at most.
  double chordal_deviation(const Mesh& mesh, std::uint32_t v, std::span<const std::uint32_t> neighbours) const;
  /// Sets the vertices of those triangles free.
  void release(const Mesh& mesh, std::span<const std::uint32_t> triangles);
};

/// Those of the triangles that lie between the two rims of a thin part: its thickness makes them slivers, and without
/// them it would have none at its rim. Rims run side by side, and the faces beyond them look away from each other.
std::vector<std::uint32_t> triangles_between_rims(const Mesh& mesh, const VertexConstraints& constraints,
                                                  std::span<const std::uint32_t> triangles,
                                                  const ExecutionContext& context);

/// Apex by apex, the vertex nearest to it (of several the first) goes there and becomes a corner, if it is free and at
/// most `max_distance` away; what earlier apexes have moved counts where it is by then. Returns how many moved.
/// Cost: O(vertices + apexes), some 20 ns each, as long as no neighbourhood of that size is full of apexes.
std::size_t constrain_apexes(Mesh& mesh, VertexConstraints& constraints, std::span<const Vec3> apexes,
                             double max_distance);

}  // namespace evenmesh
