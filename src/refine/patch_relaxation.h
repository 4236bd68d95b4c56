#pragma once
/// A few rings of vertices at rest where their surroundings stay.

#include <cstdint>
#include <span>
#include <vector>

#include "grid/sizing_field.h"
#include "refine/editable_mesh.h"
#include "refine/shape_energy.h"
#include "sample/projector.h"

namespace evenmesh {

/// What the patches of one mesh have in common. Parts of the mesh that have no vertex in common may be worked on at
/// once.
struct PatchSurroundings {
  EditableMesh& mesh;
  const Projector* projector = nullptr;  ///< null: vertices stay in their tangent planes
  const SizingField& sizing;
  ShapeEnergy energy;
  double twice_target = 0;            ///< area that a triangle should have, at edge length 1 where sizes differ
  std::vector<std::uint32_t> part{};  ///< by vertex: who may change it and its triangles; none: nobody
  std::vector<char> held{};           ///< by vertex: does not move
  std::vector<std::uint32_t> vertex_mark{}, triangle_mark{};

  /// Sets twice_target for the area that the mesh has, which it returns.
  double find_targets(const Mesh& of);
  double twice_target_at(const Vec3& p) const;
  double energy_of(std::uint32_t t) const;
  /// Energies of all triangles.
  void find_energies();
};

class PatchRelaxation {
 public:
  PatchRelaxation(PatchSurroundings& common, std::uint32_t part) : common_(common), mesh_(common.mesh), part_(part) {}

  /// The vertices up to `rings` edges from the `centres`, and the triangles around those and the centres.
  void gather(std::span<const std::uint32_t> centres, int rings, EditJournal& journal);
  /// Newton's method vertex by vertex, `sweeps` times.
  void sweep(int sweeps);
  /// Onto the surface.
  void project();
  /// Renews the energies; returns how much they grew.
  double renew_energies(EditJournal& journal);
  /// Whether every triangle faces where its corners do, within acos 0.3.
  bool faces_outwards() const;

  std::span<const std::uint32_t> vertices() const { return vertices_; }
  std::span<const std::uint32_t> triangles() const { return triangles_; }

 private:
  bool movable(std::uint32_t v) const { return common_.part[v] == part_ && !common_.held[v]; }
  struct Frame {
    Vec3 u, v;
    double twice_target;
  };
  void find_rings();
  void find_frames();
  void relax(std::size_t i);
  void gather_triangles_around(std::uint32_t v, std::uint32_t mark);
  PatchSurroundings& common_;
  EditableMesh& mesh_;
  std::uint32_t part_;
  std::uint32_t mark_ = 0;
  std::vector<std::uint32_t> vertices_, triangles_;
  std::vector<std::uint32_t> held_centres_;
  std::vector<std::uint32_t> ring_start_, ring_;  ///< by vertex of the patch: its neighbours, counter-clockwise
  std::vector<Frame> frames_;                     ///< by vertex of the patch
  std::vector<PlanePoint> flat_;
};

}  // namespace evenmesh
