/// OpenSCAD's .csg as a solid: what its statements mean.
///
/// Flat shapes are combined to one outline before it is extruded (csg_flat.h).

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "evenmesh/error.h"
#include "geometry/convex_hull.h"
#include "scene/csg_bodies.h"
#include "scene/csg_flat.h"
#include "scene/csg_tree.h"
#include "scene/scene_loader.h"

namespace evenmesh {
namespace {

/// Nothing: an empty set, which OpenSCAD's empty groups and bodies without size are.
using Solid = std::optional<Shape>;

/// Boxes that have no volume in common.
bool apart(const Box& a, const Box& b) {
  for (int i = 0; i < 3; ++i)
    if (a.hi[i] <= b.lo[i] || b.hi[i] <= a.lo[i]) return true;
  return false;
}

class CsgReader {
 public:
  CsgReader(const Source& source, SceneLoader& loader)
      : source_(source), loader_(loader), bodies_(source, loader), flat_(source, loader, bodies_) {}

  Shape read(const std::vector<CsgNode>& nodes) const {
    const CsgNode* only = marked(nodes);
    Solid solid = only ? node(*only, {}) : united(nodes, {});
    if (!solid) fail(source_, "holds no solid; its groups are empty, or all bodies have no size");
    solid->name = std::string(source_.name);
    return std::move(*solid);
  }

 private:
  using Placement = std::optional<Affine>;  ///< what the nodes around a node do to it

  /// The first node marked with '!', which stands for the whole file.
  static const CsgNode* marked(const std::vector<CsgNode>& nodes) {
    for (const CsgNode& node : nodes) {
      if (node.left_out) continue;
      if (node.only_this) return &node;
      if (const CsgNode* inner = marked(node.children)) return inner;
    }
    return nullptr;
  }

  Solid node(const CsgNode& n, const Placement& around) const {
    loader_.run().throw_if_cancelled();
    if (is_csg_group(n.name)) return united(n.children, around);
    if (n.name == "difference") return difference(n, around);
    if (n.name == "intersection") return intersection(n, around);
    if (n.name == "multmatrix") return multiplied(n, around);
    if (n.name == "hull") return hull(n, around);
    if (n.name == "linear_extrude") return pulled(n, around);
    if (n.name == "rotate_extrude") return turned(n, around);
    if (CsgBodies::is_solid(n.name) || n.name == "import") return body(n, around);
    if (CsgBodies::is_flat(n.name) || n.name == "offset") {
      fail_in_csg(source_, n.at,
                  fmt::format("{} is flat where a solid is needed; extrude it", evenmesh::quoted(n.name)));
    }
    refuse_csg_node(source_, n);
  }

  Solid placed(const CsgNode& n, Mesh mesh, const Placement& placement) const {
    if (mesh.triangles.empty()) return {};
    return in_csg(source_, n, [&] {
      const Shape shape = shape_from_mesh(std::move(mesh), n.name);
      return loader_.placed(shape, placement ? &*placement : nullptr);
    });
  }

  // Sets --------------------------------------------------------------------------------------------------------------

  Solid united(const std::vector<CsgNode>& nodes, const Placement& around) const {
    std::vector<Shape> parts;
    for (const CsgNode& child : nodes) {
      if (child.left_out) continue;
      Solid part = node(child, around);
      if (!part) continue;
      const Compound* compound = part->compound();
      if (compound != nullptr && compound->kind == Compound::Kind::unite) {  // a union of unions is one
        parts.insert(parts.end(), compound->operands.begin(), compound->operands.end());
      } else {
        parts.push_back(std::move(*part));
      }
    }
    if (parts.empty()) return {};
    return unite(std::move(parts));
  }

  Solid difference(const CsgNode& n, const Placement& around) const {
    Solid first;
    bool begun = false;
    std::vector<Shape> others;
    for (const CsgNode& child : n.children) {
      if (child.left_out) continue;
      Solid part = node(child, around);
      if (!begun) {
        first = std::move(part);
        begun = true;
      } else if (part && first && !apart(part->bounds, first->bounds)) {
        others.push_back(std::move(*part));
      }
    }
    if (!first) return {};
    return subtract(std::move(*first), std::move(others));
  }

  Solid intersection(const CsgNode& n, const Placement& around) const {
    std::vector<Shape> parts;
    bool nothing = false;
    Box box;
    for (const CsgNode& child : n.children) {
      if (child.left_out) continue;
      Solid part = node(child, around);
      if (!part) nothing = true;
      if (nothing) continue;  // the others are still checked
      if (parts.empty()) box = part->bounds;
      nothing = apart(box, part->bounds);
      box = common(box, part->bounds);
      parts.push_back(std::move(*part));
    }
    if (nothing || parts.empty()) return {};
    return in_csg(source_, n, [&] { return intersect(std::move(parts)); });
  }

  Solid hull(const CsgNode& n, const Placement& around) const {
    std::vector<Vec3> corners;
    for (const CsgNode& child : n.children) {
      if (child.left_out) continue;
      if (const Solid part = node(child, around)) add_corners(child, *part, corners);
    }
    Mesh mesh = convex_hull(corners);
    if (mesh.triangles.empty()) return {};
    return in_csg(source_, n, [&] { return shape_from_mesh(std::move(mesh), n.name); });
  }

  /// Of a body, or of those in a union.
  void add_corners(const CsgNode& n, const Shape& shape, std::vector<Vec3>& corners) const {
    const Compound* compound = shape.compound();
    if (const Mesh* mesh = shape.mesh()) {
      corners.insert(corners.end(), mesh->vertices.begin(), mesh->vertices.end());
    } else if (compound != nullptr && compound->kind == Compound::Kind::unite) {
      for (const Shape& operand : compound->operands) add_corners(n, operand, corners);
    } else {
      fail_in_csg(source_, n.at,
                  "a hull of differences and intersections is not supported; export this part as a mesh and import it");
    }
  }

  // Motions -----------------------------------------------------------------------------------------------------------

  Solid multiplied(const CsgNode& n, const Placement& around) const {
    const Affine own = bodies_.matrix(n);
    const Affine both = around ? around->after(own) : own;
    in_csg(source_, n, [&] { return both.inverse(); });
    return united(n.children, both);
  }

  Solid pulled(const CsgNode& n, const Placement& around) const {
    const Outline outline = flat_.united(n.children);
    const std::optional<LinearExtrusion> how = bodies_.linear_extrusion(n, outline);
    if (!how || outline.contours.empty()) return {};
    return placed(n, bodies_.pulled(n, outline, *how), around);
  }

  Solid turned(const CsgNode& n, const Placement& around) const {
    const Outline outline = flat_.united(n.children);
    double left = 0, right = 0;
    for (const Contour& contour : outline.contours)
      for (const Point2& p : contour) {
        left = std::min(left, p.x);
        right = std::max(right, p.x);
      }
    if (left < 0 && right > 0) {
      fail_in_csg(source_, n.at, "the flat shape lies on both sides of the axis (x = 0); move it to one side");
    }
    const std::optional<Revolution> how = bodies_.revolution(n, right - left);
    if (!how || outline.contours.empty()) return {};
    return placed(n, bodies_.turned(n, outline, *how), around);
  }

  // Bodies ------------------------------------------------------------------------------------------------------------

  Solid body(const CsgNode& n, const Placement& around) const {
    if (n.name == "import") return imported(n, around);
    std::optional<Mesh> mesh = bodies_.solid(n);
    if (!mesh) return {};
    return placed(n, std::move(*mesh), around);
  }

  Solid imported(const CsgNode& n, const Placement& around) const {
    refuse_drawing(source_, n);
    const CsgValue* file = csg_argument(n, "file", 0);
    if (file == nullptr || file->kind != CsgValue::Kind::text) fail_in_csg(source_, n.at, "import needs a file");
    return in_csg(source_, n,
                  [&] { return loader_.placed(loader_.mesh_file(file->text), around ? &*around : nullptr); });
  }

  const Source& source_;
  SceneLoader& loader_;
  CsgBodies bodies_;
  CsgFlat flat_;
};

}  // namespace

Shape read_csg_scene(const Source& source, SceneLoader& loader, const SceneLimits& limits) {
  return CsgReader(source, loader).read(parse_csg(source, limits.depth));
}

}  // namespace evenmesh
