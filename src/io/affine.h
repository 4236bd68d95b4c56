#pragma once
/// Placement of parts: x ↦ A x + t.

#include <array>

#include "evenmesh/mesh.h"
#include "io/source.h"

namespace evenmesh {

struct PartPlacement {
  std::array<Vec3, 3> columns{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  Vec3 translation;

  Vec3 linear(const Vec3& p) const { return p.x * columns[0] + p.y * columns[1] + p.z * columns[2]; }
  Vec3 operator()(const Vec3& p) const { return linear(p) + translation; }
  /// Mirrors, so that triangles must be turned to keep their outside.
  bool mirrors() const { return dot(cross(columns[0], columns[1]), columns[2]) < 0; }
  /// First `inner`, then `outer`.
  friend PartPlacement operator*(const PartPlacement& outer, const PartPlacement& inner) {
    return {{outer.linear(inner.columns[0]), outer.linear(inner.columns[1]), outer.linear(inner.columns[2])},
            outer(inner.translation)};
  }
};

/// Appends a placed copy of `part` to `mesh`.
void append_placed(const Source& source, const Mesh& part, const PartPlacement& placement, Mesh& mesh);

}  // namespace evenmesh
