#pragma once
/// Triangles whose edges are flipped, split and collapsed, and all of it taken back.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "evenmesh/mesh.h"
#include "geometry/half_edges.h"

namespace evenmesh {

/// What was written to an EditableMesh since the last commit; the way back.
class EditJournal {
 public:
  bool empty() const { return words_.empty() && places_.empty() && energies_.empty(); }

 private:
  friend class EditableMesh;
  struct Word {
    std::uint32_t* at;
    std::uint32_t before;
  };
  struct Place {
    Vec3* at;
    Vec3 before;
  };
  struct Energy {
    double* at;
    double before;
  };
  std::vector<Word> words_;
  std::vector<Place> places_;
  std::vector<Energy> energies_;
};

/// Half-edge mesh. Half-edge 3·t + c runs from corner c of triangle t to the next corner. Room for vertices and
/// triangles is made once; those not in use have no half-edge and no corners.
///
/// Changes are written through a journal and can be rolled back, in whole, until they are committed. Several threads
/// may change parts of the mesh that have no triangle in common, each with its own journal and free slots.
class EditableMesh {
 public:
  static constexpr std::uint32_t none = HalfEdges::none;

  /// Slots to put new things in; taken from the back.
  struct FreeSlots {
    std::vector<std::uint32_t> vertices, triangles;
  };

  /// @param room  how many vertices may be added at once
  /// @pre  oriented, two-manifold, with or without boundary
  EditableMesh(const Mesh& mesh, std::size_t room, const ExecutionContext& context);

  std::size_t vertex_slots() const { return outgoing_.size(); }
  std::size_t triangle_slots() const { return energy_.size(); }
  std::size_t vertices_in_use() const;
  bool vertex_in_use(std::uint32_t v) const { return outgoing_[v] != none; }
  bool triangle_in_use(std::uint32_t t) const { return origin_[3 * t] != none; }

  static std::uint32_t next(std::uint32_t h) { return HalfEdges::next(h); }
  static std::uint32_t previous(std::uint32_t h) { return HalfEdges::previous(h); }
  std::uint32_t origin(std::uint32_t h) const { return origin_[h]; }
  std::uint32_t target(std::uint32_t h) const { return origin_[next(h)]; }
  std::uint32_t apex(std::uint32_t h) const { return origin_[previous(h)]; }
  std::uint32_t opposite(std::uint32_t h) const { return opposite_[h]; }
  std::uint32_t outgoing(std::uint32_t v) const { return outgoing_[v]; }
  /// Number of edges; @pre v not on the boundary, which valence(v) == 0 tells.
  std::uint32_t valence(std::uint32_t v) const { return valence_[v]; }
  bool on_boundary(std::uint32_t v) const { return valence_[v] == 0; }
  Triangle corners(std::uint32_t t) const { return {origin_[3 * t], origin_[3 * t + 1], origin_[3 * t + 2]}; }
  const Vec3& position(std::uint32_t v) const { return position_[v]; }
  double energy(std::uint32_t t) const { return energy_[t]; }

  /// The half-edge after h among those that start at the same vertex, counter-clockwise.
  std::uint32_t rotated(std::uint32_t h) const { return opposite_[previous(h)]; }
  /// Calls visit(half-edge) for those that start at v, counter-clockwise. @pre  v not on the boundary
  template <typename Visit>
  void around(std::uint32_t v, const Visit& visit) const {
    const std::uint32_t first = outgoing_[v];
    std::uint32_t h = first;
    do {
      visit(h);
      h = rotated(h);
    } while (h != first);
  }
  bool joined(std::uint32_t a, std::uint32_t b) const;

  /// (a, b, c) and (b, a, d) become (d, c, a) and (c, d, b); h then runs from d to c.
  /// @pre  c and d are not joined, no corner is on the boundary
  void flip(std::uint32_t h, EditJournal& journal);
  /// Whether the start and the end of h have two neighbours in common and no more.
  bool may_collapse(std::uint32_t h) const;
  /// The start of h is gone, the end stays where it is. @pre  may_collapse(h)
  void collapse(std::uint32_t h, EditJournal& journal, FreeSlots& slots);
  /// A new vertex takes the triangles from half-edge `first` to half-edge `last`, counter-clockwise, which start at the
  /// same vertex. Returns the new vertex, which lies where the old one does. @pre  slots are not empty
  std::uint32_t split(std::uint32_t first, std::uint32_t last, EditJournal& journal, FreeSlots& slots);

  void move(std::uint32_t v, const Vec3& to, EditJournal& journal) {
    journal.places_.push_back({&position_[v], position_[v]});
    position_[v] = to;
  }
  void set_energy(std::uint32_t t, double energy, EditJournal& journal) {
    journal.energies_.push_back({&energy_[t], energy_[t]});
    energy_[t] = energy;
  }
  /// Before anything else: without a way back.
  void place(std::uint32_t v, const Vec3& to) { position_[v] = to; }
  void place_energy(std::uint32_t t, double energy) { energy_[t] = energy; }

  void commit(EditJournal& journal) const;
  void roll_back(EditJournal& journal) const;

 private:
  void write(std::uint32_t& word, std::uint32_t value, EditJournal& journal) {
    journal.words_.push_back({&word, word});
    word = value;
  }
  void link(std::uint32_t h, std::uint32_t o, EditJournal& journal) {
    write(opposite_[h], o, journal);
    write(opposite_[o], h, journal);
  }
  void set_triangle(std::uint32_t t, const Triangle& corners, EditJournal& journal);

  std::vector<std::uint32_t> origin_, opposite_;   ///< by half-edge
  std::vector<std::uint32_t> outgoing_, valence_;  ///< by vertex
  std::vector<Vec3> position_;                     ///< by vertex
  std::vector<double> energy_;                     ///< by triangle
};

/// Area-weighted normal at a vertex that is not on the boundary, and the cosine of the largest angle between it and the
/// normal of a triangle there; −1 where one has no area.
struct Facing {
  Vec3 normal;
  double least_cosine = 1;
};
Facing facing_of(const EditableMesh& mesh, std::uint32_t v);

}  // namespace evenmesh
