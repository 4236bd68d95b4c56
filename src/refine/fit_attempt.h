#pragma once
/// An attempt to bring mesh and surface nearer to each other at one vertex.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "refine/deviations.h"
#include "refine/vertex_constraints.h"

namespace evenmesh {

/// What attempts work on.
struct FitState {
  Mesh& mesh;
  const VertexRings& rings;
  const CellSamples& cells;
  const Projector* projector;
  const VertexConstraints& constraints;
  Deviations& deviations;
  double least_deviation;  ///< worth measuring, edge lengths
};

/// Works on a copy of the surroundings of one vertex, and writes them back when they have become better: its deviation
/// fell, no other rose above the largest around it, and no triangle became worse than the floor, or than the worst
/// around where that is below it. Reads and writes what lies up to `touched_rings` edges away, and nothing else.
class FitAttempt {
 public:
  static constexpr int touched_rings = 4;

  /// @param floor  score (VertexRings::score) that triangles must keep
  FitAttempt(const FitState& state, std::uint32_t v, double floor);

  /// Pulls a vertex onto the place of the surface that is farthest from the mesh, or as far towards it as the triangles
  /// allow, while those around it give way.
  bool reach();
  /// Lifts the triangle under that place off the surface, half way towards it.
  bool lift();
  /// The same as reach(), after an edge nearby was flipped. When that has helped, the mesh needs new rings.
  bool flip();

 private:
  /// An edge a–b, and the corners beyond it.
  struct Quad {
    std::uint32_t a, b, c, d, left, right;  ///< left has a, b, c, right has b, a, d
  };

  Mesh patch();
  std::span<const Vec3> samples(std::uint32_t v) const { return state_.cells.of(vertices_[v]); }
  GapFinder gaps(const VertexRings& rings) const { return {mesh_, rings, state_.projector, state_.least_deviation}; }
  bool is_movable(std::uint32_t v) const;
  bool pull_one(const VertexRings& rings, std::span<const double> shares);
  bool pull(const VertexRings& rings, std::uint32_t mover, const Vec3& target);
  bool keep_or_undo(const VertexRings& rings);
  void surround(const VertexRings& rings, std::span<const std::uint32_t> centres, int distance);
  bool triangles_are_good(const VertexRings& rings) const;
  double largest_before() const;
  bool has_moved(std::uint32_t v) const;
  bool is_better(const VertexRings& rings);
  bool intersects(const VertexRings& rings) const;
  void write_back(const VertexRings& rings);
  std::vector<Quad> quads() const;
  std::optional<Quad> quad(std::uint32_t a, std::uint32_t b) const;
  void flip(const Quad& quad);

  const FitState& state_;
  double floor_;
  std::vector<std::uint32_t> vertices_, triangles_;  ///< of the mesh, by vertex and triangle of the patch
  Mesh original_, mesh_;                             ///< the patch; its vertex 0 is the one meant
  VertexRings rings_;
  std::vector<Vec3> facing_;           ///< by triangle: its normal before
  std::vector<std::uint32_t> region_;  ///< vertices that may move
  std::vector<std::pair<std::uint32_t, double>>
      measured_;  ///< vertices around which something moved, squared deviation
  std::optional<Quad> flipped_;
  double deviation_;
  Gap gap_;
};

}  // namespace evenmesh
