#pragma once
/// The point of a surface that is nearest to a given one.

#include <cstdint>
#include <limits>
#include <memory>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

struct ClosestPoint {
  Vec3 point;  ///< on the surface
  std::uint32_t triangle = 0;
  double squared_distance = std::numeric_limits<double>::infinity();  ///< infinite when nothing lies within the limit

  bool found() const { return squared_distance < std::numeric_limits<double>::infinity(); }
};

/// Answers closest-point queries on a triangle mesh. Immutable, cheap to copy; keeps no reference to the mesh.
class SurfaceQuery {
 public:
  /// Cost: about 0.3 µs per triangle on two cores, 250 bytes per triangle.
  /// @throws InvalidInput  if the mesh has no triangle
  explicit SurfaceQuery(const Mesh& mesh, ExecutionContext& context = ExecutionContext::silent());

  /// The point of the surface nearest to p; of several triangles at the same distance, the one of lowest index.
  ///
  /// Triangles are found through float boxes widened by their rounding, distances computed in double: the result is
  /// that of trying all triangles in double precision. Safe from several threads.
  /// @param max_distance  model units; a good upper bound makes the search faster, what lies beyond is not found
  /// Cost: about a microsecond where p is near the surface.
  ClosestPoint closest(const Vec3& p, double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Whether a point of the surface lies within `distance` of p. Cheap where it is clearly so, or clearly not.
  bool reaches(const Vec3& p, double distance) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace evenmesh
