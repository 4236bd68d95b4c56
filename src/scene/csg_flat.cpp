#include "scene/csg_flat.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "geometry/convex_hull.h"

namespace evenmesh {
namespace {

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

}  // namespace

Outline CsgFlat::node(const CsgNode& n, const std::optional<Affine>& motion) const {
  loader_.run().throw_if_cancelled();
  if (is_csg_group(n.name)) return united(n.children, motion);
  if (n.name == "difference") return difference(n, motion);
  if (n.name == "intersection") return intersection(n, motion);
  if (n.name == "multmatrix") return multiplied(n, motion);
  if (n.name == "hull") return hull(n, motion);
  if (n.name == "offset") return offset(n, motion);
  if (n.name == "import") refuse_drawing(source_, n);
  if (CsgBodies::is_flat(n.name)) {
    Outline outline = bodies_.flat(n).value_or(Outline{});
    return motion ? moved(std::move(outline), *motion) : outline;
  }
  if (CsgBodies::is_solid(n.name) || n.name == "import" || n.name == "linear_extrude" || n.name == "rotate_extrude") {
    fail_in_csg(source_, n.at,
                fmt::format("{} is a solid where a flat shape is needed to extrude", evenmesh::quoted(n.name)));
  }
  refuse_csg_node(source_, n);
}

Outline CsgFlat::united(const std::vector<CsgNode>& nodes, const std::optional<Affine>& motion) const {
  std::vector<Outline> parts;
  const CsgNode* last = nullptr;
  for (const CsgNode& child : nodes) {
    if (child.left_out) continue;
    Outline part = node(child, motion);
    if (part.contours.empty()) continue;
    parts.push_back(std::move(part));
    last = &child;
  }
  if (parts.empty()) return {};
  if (parts.size() == 1) return std::move(parts.front());
  return in_csg(source_, *last, [&] { return combined(FlatSet::unite, parts); });
}

Outline CsgFlat::difference(const CsgNode& n, const std::optional<Affine>& motion) const {
  std::vector<Outline> parts;
  for (const CsgNode& child : n.children) {
    if (child.left_out) continue;
    Outline part = node(child, motion);
    if (parts.empty() || !part.contours.empty()) parts.push_back(std::move(part));
  }
  if (parts.empty() || parts.front().contours.empty()) return {};
  if (parts.size() == 1) return std::move(parts.front());
  return in_csg(source_, n, [&] { return combined(FlatSet::subtract, parts); });
}

Outline CsgFlat::intersection(const CsgNode& n, const std::optional<Affine>& motion) const {
  std::vector<Outline> parts;
  bool nothing = false;
  for (const CsgNode& child : n.children) {
    if (child.left_out) continue;
    parts.push_back(node(child, motion));
    nothing = nothing || parts.back().contours.empty();
  }
  if (nothing || parts.empty()) return {};
  if (parts.size() == 1) return std::move(parts.front());
  return in_csg(source_, n, [&] { return combined(FlatSet::intersect, parts); });
}

Outline CsgFlat::hull(const CsgNode& n, const std::optional<Affine>& motion) const {
  std::vector<Point2> points;
  for (const CsgNode& child : n.children) {
    if (child.left_out) continue;
    for (const Contour& contour : node(child, motion).contours)
      points.insert(points.end(), contour.begin(), contour.end());
  }
  Contour around = convex_hull(std::move(points));
  if (around.size() < 3) return {};
  return {{std::move(around)}};
}

/// In the plane of its children; a motion around it stretches what was grown.
Outline CsgFlat::offset(const CsgNode& n, const std::optional<Affine>& motion) const {
  const Outline grown = in_csg(source_, n, [&] { return offset_outline(united(n.children), bodies_.flat_offset(n)); });
  return motion ? moved(grown, *motion) : grown;
}

Outline CsgFlat::multiplied(const CsgNode& n, const std::optional<Affine>& motion) const {
  const Affine own = in_plane(bodies_.matrix(n));
  const Affine both = motion ? motion->after(own) : own;
  in_csg(source_, n, [&] { return both.inverse(); });
  return united(n.children, both);
}

}  // namespace evenmesh
