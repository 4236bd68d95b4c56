#pragma once
/// OpenSCAD's nodes without children: their arguments to outlines and meshes.

#include <optional>

#include "evenmesh/mesh.h"
#include "scene/bodies.h"
#include "scene/csg_tree.h"
#include "scene/flat_offset.h"
#include "scene/scene_loader.h"

namespace evenmesh {

/// Reads the arguments of nodes; complains with line and column.
class CsgBodies {
 public:
  CsgBodies(const Source& source, SceneLoader& loader) : source_(source), loader_(loader) {}

  static bool is_solid(std::string_view name);  ///< cube, sphere, cylinder, polyhedron
  static bool is_flat(std::string_view name);   ///< square, circle, polygon

  /// Nothing where a size is 0 or below, as in OpenSCAD.
  std::optional<Mesh> solid(const CsgNode& node) const;
  std::optional<Outline> flat(const CsgNode& node) const;

  std::optional<LinearExtrusion> linear_extrusion(const CsgNode& node, const Outline& outline) const;
  /// @param reach  largest distance of the outline from the axis
  std::optional<Revolution> revolution(const CsgNode& node, double reach) const;
  FlatOffset flat_offset(const CsgNode& node) const;
  Affine matrix(const CsgNode& node) const;

  Mesh pulled(const CsgNode& node, const Outline& outline, const LinearExtrusion& how) const;
  Mesh turned(const CsgNode& node, const Outline& outline, const Revolution& how) const;

 private:
  double number(const CsgNode& node, const char* name, std::size_t position, double otherwise) const;
  Roundness roundness(const CsgNode& node) const;
  std::uint64_t fragments(const CsgNode& node, double radius) const;
  Contour point_list(const CsgValue& list) const;
  std::vector<std::uint32_t> index_list(const CsgValue& list, std::size_t points) const;
  std::optional<Mesh> ball(const CsgNode& node) const;
  std::optional<Mesh> cylinder(const CsgNode& node) const;
  std::optional<Mesh> box(const CsgNode& node) const;
  std::optional<Mesh> faces(const CsgNode& node) const;
  Outline polygon(const CsgNode& node) const;
  void spend(const CsgNode& node, std::uint64_t triangles) const;

  const Source& source_;
  SceneLoader& loader_;
};

}  // namespace evenmesh
