#pragma once
/// How far a surface lies from a mesh whose connectivity changes.

#include <cstdint>
#include <span>
#include <vector>

#include "refine/editable_mesh.h"
#include "sample/projector.h"

namespace evenmesh {

/// Points of the surface, each kept with the triangle that it was found nearest to.
class ReferencePoints {
 public:
  /// The vertices of the mesh, and the middles of its triangles, brought onto the surface.
  ReferencePoints(const EditableMesh& mesh, const Projector* projector, const ExecutionContext& context);

  /// Whether the points of the triangles `before` lie near the triangles `now`: within `tolerance`, or no farther than
  /// the farthest of them did. Those not in use are skipped. If so they belong to those from now on.
  /// Cost: points times triangles, about 5 ns each.
  bool hand_over(const EditableMesh& mesh, std::span<const std::uint32_t> before, std::span<const std::uint32_t> now,
                 double tolerance);

 private:
  void add(const Vec3& p, double squared_distance, std::uint32_t triangle);

  std::vector<Vec3> points_;
  std::vector<double> squared_distance_;  ///< by point
  std::vector<std::uint32_t> first_;      ///< by triangle, and by point the next of the same
  std::vector<std::uint32_t> next_;
};

}  // namespace evenmesh
