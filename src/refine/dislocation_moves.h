#pragma once
/// Chains of flips, splits and collapses that carry dislocations from one irregular vertex to another.

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "refine/patch_relaxation.h"
#include "refine/reference_points.h"
#include "refine/vertex_constraints.h"

namespace evenmesh {

/// What a vertex of that many edges costs, in halves of what one with five or seven does; those too few or too many are
/// not made.
constexpr int valence_cost(std::uint32_t valence) {
  constexpr int costs[] = {1000, 1000, 1000, 1000, 5, 2, 0, 2, 5};
  return valence < 9 ? costs[valence] : 1000;
}

struct MoveParameters {
  double irregular_cost = 0.4;  ///< energy of a vertex with five or seven edges, beyond that of the shapes
  double temperature = 0.01;    ///< energy
  double count_cost = 0.02;     ///< energy by the square of vertices too many or too few
  double tolerance = 0;         ///< of the distance from the surface, model units
  double climb_share = 0.3;     ///< how much rarer splits and collapses are tried than flips
};

struct MoveCounts {
  std::size_t attempts = 0, relaxed = 0, off_surface = 0, accepted = 0;
};

/// Works on one part of a mesh, alone there.
class DislocationMoves {
 public:
  DislocationMoves(PatchSurroundings& common, ReferencePoints& points, const VertexConstraints& constraints,
                   std::uint32_t part, EditableMesh::FreeSlots slots, std::uint64_t seed, int surplus)
      : common_(common),
        mesh_(common.mesh),
        points_(points),
        constraints_(constraints),
        part_(part),
        slots_(std::move(slots)),
        random_(seed),
        patch_(common, part),
        surplus_(surplus) {}

  void add_irregular(std::uint32_t v) { irregular_.push_back(v); }
  std::size_t irregular_count() const { return irregular_.size(); }
  /// Vertices there are too many, below zero too few.
  int surplus() const { return surplus_; }
  /// Tries a chain that begins at one of the irregular vertices.
  void attempt_any(const MoveParameters& parameters);
  MoveCounts counts;

 private:
  enum class Kind : char { flip, collapse, split };
  struct Edit {
    Kind kind = Kind::flip;
    std::uint32_t first = EditableMesh::none, last = EditableMesh::none;  ///< half-edges
    int cost = 0;
  };

  bool attempt(std::uint32_t v, const MoveParameters& parameters);
  bool mine(std::uint32_t v) const { return common_.part[v] == part_; }
  int change(std::uint32_t v, int by) const {
    return valence_cost(mesh_.valence(v) + static_cast<std::uint32_t>(by)) - valence_cost(mesh_.valence(v));
  }
  void consider(const Edit& edit, double share);
  void consider_flip(std::uint32_t h);
  void consider_collapse(std::uint32_t h);
  void consider_splits(std::uint32_t v, std::uint32_t wing);
  bool choose(std::uint32_t v, Edit& edit);
  bool flip(std::uint32_t h);
  bool collapse(std::uint32_t h);
  void split(std::uint32_t first, std::uint32_t last);
  bool apply(const Edit& edit);
  void touch(std::uint32_t v);
  bool grow_chain(std::uint32_t v);
  double energy_of_gone();
  bool settle(const MoveParameters& parameters);
  bool stays_near(double tolerance);
  bool made_here(std::uint32_t a, std::uint32_t b) const;

  PatchSurroundings& common_;
  EditableMesh& mesh_;
  ReferencePoints& points_;
  const VertexConstraints& constraints_;
  std::uint32_t part_;
  EditableMesh::FreeSlots slots_, slots_before_;
  Random random_;
  PatchRelaxation patch_;
  EditJournal journal_;
  std::vector<std::uint32_t> irregular_;  ///< and some that no longer are
  int surplus_;
  // The chain.
  std::vector<std::uint32_t> touched_, gone_;       ///< vertices that have changed, triangles that vanished
  std::vector<std::array<std::uint32_t, 2>> made_;  ///< edges, lower vertex first
  int cost_ = 0, added_ = 0;
  double climb_share_ = 0;
  // The choice of the next edit.
  double weight_ = 0;
  Edit chosen_;
};

}  // namespace evenmesh
