#pragma once
/// How far a surface lies from a mesh whose connectivity changes.

#include <cstdint>
#include <limits>
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

  /// Whether the points of the triangles `before` lie near those of the triangles `now` that face the same way, and the
  /// middles of the triangles `changed` near the surface: within `tolerance`, or no farther than the farthest of the
  /// points did. If so they belong to those from now on. `now` is
  /// ascending; triangles not in use may be among `before`.
  /// Cost: points times triangles, some nanoseconds each, and a projection for each triangle changed.
  bool hand_over(const EditableMesh& mesh, std::span<const std::uint32_t> before, std::span<const std::uint32_t> now,
                 std::span<const std::uint32_t> changed, double tolerance);

 private:
  struct Corners;
  struct Nearest {
    double squared_distance = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = EditableMesh::none;
  };
  /// @param guess  a candidate that is likely to be near
  Nearest nearest(std::uint32_t point, std::span<const Corners> candidates, std::size_t guess) const;
  bool near_surface(const EditableMesh& mesh, std::uint32_t triangle, double squared_distance) const;
  void add(const Vec3& p, const Vec3& normal, double squared_distance, std::uint32_t triangle);

  const Projector* projector_;
  std::vector<Vec3> points_;
  std::vector<Vec3> normals_;             ///< by point; zero where it may lie on any side
  std::vector<double> squared_distance_;  ///< by point
  std::vector<std::uint32_t> first_;      ///< by triangle, and by point the next of the same
  std::vector<std::uint32_t> next_;
};

}  // namespace evenmesh
