#pragma once
/// How far a mesh lies from the surface, vertex by vertex.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "refine/cell_samples.h"
#include "refine/vertex_rings.h"
#include "sample/projector.h"

namespace evenmesh {

/// A place where mesh and surface are apart.
struct Gap {
  Vec3 on_mesh, on_surface;
  double squared_distance = -1;
};

/// Gaps between surface and mesh around a vertex: from the samples of its cell to the triangles around it, and from
/// points of its edges and triangles to the surface where the mesh is bent.
class GapFinder {
 public:
  /// @param projector  null: samples alone count
  /// @param least      deviations below are not worth measuring, in edge lengths
  GapFinder(const Mesh& mesh, const VertexRings& rings, const Projector* projector, double least)
      : mesh_(mesh), rings_(rings), projector_(projector), least_(least) {}

  Gap largest(std::uint32_t v, std::span<const Vec3> samples) const;
  /// Squared distance of the largest; infinite as soon as one is above `squared_limit`, 0 where all are below
  /// the least.
  double deviation(std::uint32_t v, std::span<const Vec3> samples,
                   double squared_limit = std::numeric_limits<double>::infinity()) const;
  /// Whether all samples are nearer than √squared_limit to the triangles around v.
  bool all_within(std::uint32_t v, std::span<const Vec3> samples, double squared_limit) const;

 private:
  bool is_bent(std::uint32_t v) const;
  /// Calls use(gap) for points of the mesh around v until it returns false, except for those that have a sample within
  /// √squared_least: the surface is no farther. Middles of edges and triangles belong to one of their bent vertices.
  template <typename Use>
  void each_of_mesh(std::uint32_t v, std::span<const Vec3> samples, const double& squared_least, const Use& use) const;
  Vec3 closest_on(std::uint32_t triangle, const Vec3& p) const;
  /// Looks at triangle number `hint` around v first, and leaves there the one that is near: samples come in an order in
  /// which neighbours follow each other.
  bool is_within(const Vec3& p, std::uint32_t v, double squared_limit, std::size_t& hint) const;
  Gap gap_of_sample(const Vec3& p, std::uint32_t v) const;

  const Mesh& mesh_;
  const VertexRings& rings_;
  const Projector* projector_;
  double least_;
};

/// The deviations of all vertices of a mesh.
class Deviations {
 public:
  explicit Deviations(std::size_t vertices) : squared_(vertices, 0), marked_(vertices, 1), hopeless_(vertices, 0) {}

  /// Squared, model units; 0 where nobody asks how large.
  double operator[](std::uint32_t v) const { return squared_[v]; }
  double largest() const;
  /// Then there is hope for v again.
  void set(std::uint32_t v, double squared) {
    squared_[v] = squared;
    hopeless_[v] = 0;
  }
  void mark(std::uint32_t v) { marked_[v] = 1; }
  void mark_all() { marked_.assign(marked_.size(), 1); }
  /// That nothing can be done about v, until it is measured again.
  void give_up(std::uint32_t v) { hopeless_[v] = 1; }
  /// Measures the vertices that are marked; all of them at first.
  void update(const GapFinder& gaps, const CellSamples& cells, const ExecutionContext& context);

  /// Vertices whose deviation is above `share` of the largest, except those given up, the largest first.
  std::vector<std::uint32_t> largest_first(double share) const;
  /// Those up to `distance` edges around the `count` largest, which are given another chance: when something gives way
  /// there, there is hope again.
  std::vector<std::uint32_t> around_the_largest(std::size_t count, int distance, const VertexRings& rings);

 private:
  std::vector<double> squared_;
  std::vector<char> marked_;    ///< squared_ may be wrong
  std::vector<char> hopeless_;  ///< an attempt was in vain, and nothing has changed since
};

/// The vertices up to `distance` edges away from v: v, its neighbours, and so on.
std::vector<std::uint32_t> vertices_around(const VertexRings& rings, std::uint32_t v, int distance);

}  // namespace evenmesh
