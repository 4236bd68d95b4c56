/// OpenSCAD's .csg as a solid: what its statements mean.
///
/// Flat shapes become solids where they are extruded: pulling up and turning keep unions, differences and
/// intersections, so that these are done to solids.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "evenmesh/error.h"
#include "scene/csg_bodies.h"
#include "scene/csg_tree.h"
#include "scene/workshop.h"

namespace evenmesh {
namespace {

/// Nothing: an empty set, which OpenSCAD's empty groups and bodies without size are.
using Solid = std::optional<Shape>;

bool among(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_group(std::string_view name) {
  return among(name, {"group", "union", "render", "color"});
}

/// Boxes that have no volume in common.
bool apart(const Box& a, const Box& b) {
  for (int i = 0; i < 3; ++i)
    if (a.hi[i] <= b.lo[i] || b.hi[i] <= a.lo[i]) return true;
  return false;
}

/// The part of a motion that acts in the plane.
Affine in_plane(const Affine& m) {
  return {{Vec3{m.column[0].x, m.column[0].y, 0}, Vec3{m.column[1].x, m.column[1].y, 0}, Vec3{0, 0, 1}},
          {m.translation.x, m.translation.y, 0}};
}

Outline moved(Outline outline, const Affine& motion) {
  for (Contour& contour : outline.contours) {
    for (Point2& p : contour) {
      const Vec3 q = motion(Vec3{p.x, p.y, 0});
      p = {q.x, q.y};
    }
    if (motion.determinant() < 0) std::reverse(contour.begin(), contour.end());
  }
  return outline;
}

class CsgReader {
 public:
  CsgReader(const Source& source, Workshop& workshop)
      : source_(source), workshop_(workshop), bodies_(source, workshop) {}

  Shape read(const std::vector<CsgNode>& nodes) const {
    const CsgNode* only = marked(nodes);
    Solid solid = only ? node(*only, {}) : united(nodes, {});
    if (!solid) fail(source_, "holds no solid; its groups are empty, or all bodies have no size");
    solid->name = std::string(source_.name);
    return std::move(*solid);
  }

 private:
  /// Makes a solid of an outline.
  using Extrude = std::function<Mesh(const CsgNode&, const Outline&)>;

  /// What the nodes around a node do to it.
  struct Around {
    std::optional<Affine> placement{};    ///< of solids
    const Extrude* extrude = nullptr;     ///< flat shapes are meant
    std::optional<Affine> in_plane_of{};  ///< their motion before they are extruded
  };

  /// The first node marked with '!', which stands for the whole file.
  static const CsgNode* marked(const std::vector<CsgNode>& nodes) {
    for (const CsgNode& node : nodes) {
      if (node.left_out) continue;
      if (node.only_this) return &node;
      if (const CsgNode* inner = marked(node.children)) return inner;
    }
    return nullptr;
  }

  Solid node(const CsgNode& n, const Around& around) const {
    workshop_.run().throw_if_cancelled();
    if (is_group(n.name)) return united(n.children, around);
    if (n.name == "difference") return difference(n, around);
    if (n.name == "intersection") return intersection(n, around);
    if (n.name == "multmatrix") return multiplied(n, around);
    if (n.name == "linear_extrude") return pulled(n, around);
    if (n.name == "rotate_extrude") return turned(n, around);
    if (CsgBodies::is_flat(n.name)) return flat(n, around);
    if (CsgBodies::is_solid(n.name) || n.name == "import") return body(n, around);
    not_supported(n);
  }

  [[noreturn]] void not_supported(const CsgNode& n) const {
    const bool known = among(n.name, {"hull", "minkowski", "projection", "text", "surface", "offset", "resize", "roof",
                                      "fill", "import_stl", "import_off", "import_dxf", "dxf_linear_extrude"});
    fail_in_csg(source_, n.at,
                fmt::format("{} {} is not supported; export this part as a mesh and import it",
                            known ? "the OpenSCAD node" : "the unknown node", evenmesh::quoted(n.name)));
  }

  /// Runs what may complain without knowing where it is.
  template <typename Make>
  auto at(const CsgNode& n, const Make& make) const {
    try {
      return make();
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      fail_in_csg(source_, n.at, fmt::format("{}: {}", n.name, error.what()));
    }
  }

  Solid placed(const CsgNode& n, Mesh mesh, const std::optional<Affine>& placement) const {
    return at(n, [&] {
      const Shape shape = shape_from_mesh(std::move(mesh), n.name);
      return workshop_.placed(shape, placement ? &*placement : nullptr);
    });
  }

  // Sets --------------------------------------------------------------------------------------------------------------

  Solid united(const std::vector<CsgNode>& nodes, const Around& around) const {
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

  Solid difference(const CsgNode& n, const Around& around) const {
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

  Solid intersection(const CsgNode& n, const Around& around) const {
    std::vector<Shape> parts;
    bool nothing = false;
    Box common;
    for (const CsgNode& child : n.children) {
      if (child.left_out) continue;
      Solid part = node(child, around);
      if (!part) nothing = true;
      if (nothing) continue;  // the others are still checked
      if (parts.empty()) common = part->bounds;
      nothing = apart(common, part->bounds);
      for (int i = 0; i < 3; ++i) {
        common.lo[i] = std::max(common.lo[i], part->bounds.lo[i]);
        common.hi[i] = std::min(common.hi[i], part->bounds.hi[i]);
      }
      parts.push_back(std::move(*part));
    }
    if (nothing || parts.empty()) return {};
    return at(n, [&] { return intersect(std::move(parts)); });
  }

  // Motions -----------------------------------------------------------------------------------------------------------

  Solid multiplied(const CsgNode& n, const Around& around) const {
    Affine own = bodies_.matrix(n);
    if (around.extrude != nullptr) own = in_plane(own);
    Around inner = around;
    std::optional<Affine>& motion = around.extrude != nullptr ? inner.in_plane_of : inner.placement;
    motion = motion ? motion->after(own) : own;
    at(n, [&] { return motion->inverse(); });
    return united(n.children, inner);
  }

  void refuse_solid_in_flat(const CsgNode& n, const Around& around) const {
    if (around.extrude == nullptr) return;
    fail_in_csg(source_, n.at,
                fmt::format("{} is a solid where a flat shape is needed to extrude", evenmesh::quoted(n.name)));
  }

  Solid extruded(const CsgNode& n, const Around& around, const Extrude& extrude) const {
    return united(n.children, {.placement = around.placement, .extrude = &extrude});
  }

  Solid pulled(const CsgNode& n, const Around& around) const {
    refuse_solid_in_flat(n, around);
    Contour points;
    for (const CsgNode& child : n.children) add_points(child, {}, points);
    const std::optional<LinearExtrusion> how = bodies_.linear_extrusion(n, points);
    const Extrude extrude = [&](const CsgNode& leaf, const Outline& outline) {
      return how ? bodies_.pulled(leaf, outline, *how) : Mesh{};
    };
    return extruded(n, around, extrude);
  }

  Solid turned(const CsgNode& n, const Around& around) const {
    refuse_solid_in_flat(n, around);
    Contour points;
    for (const CsgNode& child : n.children) add_points(child, {}, points);
    double left = 0, right = 0;
    for (const Point2& p : points) left = std::min(left, p.x), right = std::max(right, p.x);
    if (left < 0 && right > 0) {
      fail_in_csg(source_, n.at, "the flat shape lies on both sides of the axis (x = 0); move it to one side");
    }
    const std::optional<Revolution> how = bodies_.revolution(n, right - left);
    const Extrude extrude = [&](const CsgNode& leaf, const Outline& outline) {
      return how ? bodies_.turned(leaf, outline, *how) : Mesh{};
    };
    return extruded(n, around, extrude);
  }

  /// The points of flat shapes; what is taken away does not count, and what cuts it off is not known.
  void add_points(const CsgNode& n, const std::optional<Affine>& motion, Contour& points) const {
    if (n.left_out) return;
    if (CsgBodies::is_flat(n.name)) {
      const std::optional<Outline> outline = bodies_.flat(n);
      if (!outline) return;
      for (const Contour& contour : moved(*outline, motion.value_or(Affine{})).contours)
        points.insert(points.end(), contour.begin(), contour.end());
      return;
    }
    std::optional<Affine> inner = motion;
    if (n.name == "multmatrix") {
      const Affine own = in_plane(bodies_.matrix(n));
      inner = motion ? motion->after(own) : own;
    }
    for (const CsgNode& child : n.children) {
      add_points(child, inner, points);
      if (n.name == "difference" && !child.left_out) break;
    }
  }

  // Bodies ------------------------------------------------------------------------------------------------------------

  Solid flat(const CsgNode& n, const Around& around) const {
    if (around.extrude == nullptr) {
      fail_in_csg(source_, n.at,
                  fmt::format("{} is flat where a solid is needed; extrude it", evenmesh::quoted(n.name)));
    }
    const std::optional<Outline> outline = bodies_.flat(n);
    if (!outline) return {};
    Mesh mesh = (*around.extrude)(n, around.in_plane_of ? moved(*outline, *around.in_plane_of) : *outline);
    if (mesh.triangles.empty()) return {};
    return placed(n, std::move(mesh), around.placement);
  }

  Solid body(const CsgNode& n, const Around& around) const {
    refuse_solid_in_flat(n, around);
    if (n.name == "import") return imported(n, around);
    std::optional<Mesh> mesh = bodies_.solid(n);
    if (!mesh) return {};
    return placed(n, std::move(*mesh), around.placement);
  }

  Solid imported(const CsgNode& n, const Around& around) const {
    const CsgValue* file = csg_argument(n, "file", 0);
    if (file == nullptr || file->kind != CsgValue::Kind::text) fail_in_csg(source_, n.at, "import needs a file");
    return at(n, [&] {
      return workshop_.placed(workshop_.mesh_file(file->text), around.placement ? &*around.placement : nullptr);
    });
  }

  const Source& source_;
  Workshop& workshop_;
  CsgBodies bodies_;
};

}  // namespace

Shape read_csg_scene(const Source& source, Workshop& workshop, const SceneLimits& limits) {
  return CsgReader(source, workshop).read(parse_csg(source, limits.depth));
}

}  // namespace evenmesh
