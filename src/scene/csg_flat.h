#pragma once
/// OpenSCAD's flat shapes, their sets and motions, as one outline.

#include <optional>
#include <vector>

#include "evenmesh/solid.h"
#include "scene/crossings.h"
#include "scene/csg_bodies.h"
#include "scene/csg_tree.h"
#include "scene/outline.h"
#include "scene/scene_loader.h"

namespace evenmesh {

/// Reads what stands within an extrusion; complains with line and column.
class CsgFlat {
 public:
  CsgFlat(const Source& source, SceneLoader& loader, const CsgBodies& bodies)
      : source_(source), loader_(loader), bodies_(bodies) {}

  /// Without contours where nothing is left.
  Outline united(const std::vector<CsgNode>& nodes, const std::optional<Affine>& motion = {}) const;

 private:
  Outline node(const CsgNode& n, const std::optional<Affine>& motion) const;
  Outline difference(const CsgNode& n, const std::optional<Affine>& motion) const;
  Outline intersection(const CsgNode& n, const std::optional<Affine>& motion) const;
  Outline hull(const CsgNode& n, const std::optional<Affine>& motion) const;
  Outline offset(const CsgNode& n, const std::optional<Affine>& motion) const;
  Outline multiplied(const CsgNode& n, const std::optional<Affine>& motion) const;

  const Source& source_;
  SceneLoader& loader_;
  const CsgBodies& bodies_;
};

}  // namespace evenmesh
