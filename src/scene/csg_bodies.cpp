#include "scene/csg_bodies.h"

#include <algorithm>
#include <cmath>

#include "evenmesh/error.h"

namespace evenmesh {
namespace {

constexpr double max_pieces = 1e6;  // of a circle, or along an extrusion

bool is_number(const CsgValue* value) {
  return value != nullptr && value->kind == CsgValue::Kind::number;
}

}  // namespace

bool CsgBodies::is_solid(std::string_view name) {
  return name == "cube" || name == "sphere" || name == "cylinder" || name == "polyhedron";
}

bool CsgBodies::is_flat(std::string_view name) {
  return name == "square" || name == "circle" || name == "polygon";
}

double CsgBodies::number(const CsgNode& node, const char* name, std::size_t position, double otherwise) const {
  const CsgValue* value = csg_argument(node, name, position);
  return value == nullptr ? otherwise : csg_number(source_, *value);
}

void CsgBodies::spend(const CsgNode& node, std::uint64_t triangles) const {
  try {
    loader_.spend(triangles);
  } catch (const UnusableInput& error) {
    fail_in_csg(source_, node.at, error.what());
  }
}

Roundness CsgBodies::roundness(const CsgNode& node) const {
  constexpr std::size_t by_name = 99;
  return {.fn = number(node, "$fn", by_name, 0),
          .fa = std::max(number(node, "$fa", by_name, 12), 0.01),
          .fs = std::max(number(node, "$fs", by_name, 2), 0.01)};
}

std::uint64_t CsgBodies::fragments(const CsgNode& node, double radius) const {
  const double count = roundness(node).fragments(radius);
  if (!(count <= max_pieces))
    fail_in_csg(source_, node.at, "asks for more than 1,000,000 pieces of a circle; lower $fn");
  return static_cast<std::uint64_t>(count);
}

// Solids --------------------------------------------------------------------------------------------------------------

std::optional<Mesh> CsgBodies::solid(const CsgNode& node) const {
  if (node.name == "cube") return box(node);
  if (node.name == "sphere") return ball(node);
  if (node.name == "cylinder") return cylinder(node);
  return faces(node);
}

std::optional<Mesh> CsgBodies::box(const CsgNode& node) const {
  const CsgValue* size = csg_argument(node, "size", 0);
  Vec3 sides{1, 1, 1};
  if (is_number(size)) {
    const double all = csg_number(source_, *size);
    sides = {all, all, all};
  } else if (size != nullptr) {
    const auto three = csg_numbers(source_, *size, 3, 3);
    sides = {three[0], three[1], three[2]};
  }
  if (!(sides.x > 0 && sides.y > 0 && sides.z > 0)) return {};
  const bool center = csg_flag(node, "center", 1);
  return extrude(rectangle_outline(sides.x, sides.y, center), {.up = {0, 0, sides.z}, .center = center});
}

std::optional<Mesh> CsgBodies::ball(const CsgNode& node) const {
  const double radius = number(node, "r", 0, 1);
  if (!(radius > 0)) return {};
  const std::uint64_t around = fragments(node, radius);
  const Revolution how{.fragments = around};
  spend(node, (around + 4) * around);
  return revolve(half_ball_outline(radius, around), how);
}

std::optional<Mesh> CsgBodies::cylinder(const CsgNode& node) const {
  const double height = number(node, "h", 0, 1), below = number(node, "r1", 1, 1), above = number(node, "r2", 2, 1);
  if (!(height > 0) || below < 0 || above < 0 || !(below + above > 0)) return {};
  const double z = csg_flag(node, "center", 3) ? -height / 2 : 0;
  Contour side{{0, z}};
  if (below > 0) side.push_back({below, z});
  if (above > 0) side.push_back({above, z + height});
  side.push_back({0, z + height});
  return turned(node, {{std::move(side)}}, {.fragments = fragments(node, std::max(below, above))});
}

std::vector<std::uint32_t> CsgBodies::index_list(const CsgValue& list, std::size_t points) const {
  if (list.kind != CsgValue::Kind::list) fail_in_csg(source_, list.at, "needs a list of indices");
  std::vector<std::uint32_t> indices;
  for (const CsgValue& item : list.list) {
    const double index = csg_number(source_, item);
    if (!(index >= 0 && index < static_cast<double>(points) && index == std::floor(index))) {
      fail_in_csg(source_, item.at, "is no index of a point; there are " + std::to_string(points) + ", counted from 0");
    }
    indices.push_back(static_cast<std::uint32_t>(index));
  }
  return indices;
}

std::optional<Mesh> CsgBodies::faces(const CsgNode& node) const {
  const CsgValue* points = csg_argument(node, "points", 0);
  const CsgValue* faces = csg_argument(node, "faces", 1);
  if (faces == nullptr) faces = csg_argument(node, "triangles", 99);
  if (points == nullptr || faces == nullptr || points->kind != CsgValue::Kind::list ||
      faces->kind != CsgValue::Kind::list) {
    fail_in_csg(source_, node.at, "needs lists of points and faces");
  }
  std::vector<Vec3> vertices;
  for (const CsgValue& item : points->list) {
    const auto p = csg_numbers(source_, item, 3, 3);
    vertices.push_back({p[0], p[1], p[2]});
  }
  std::vector<std::vector<std::uint32_t>> rings;
  for (const CsgValue& item : faces->list) rings.push_back(index_list(item, vertices.size()));
  Mesh mesh = polyhedron(std::move(vertices), rings);
  if (mesh.triangles.empty()) return {};
  return mesh;
}

// Flat shapes ---------------------------------------------------------------------------------------------------------

std::optional<Outline> CsgBodies::flat(const CsgNode& node) const {
  Outline outline;
  if (node.name == "square") {
    const CsgValue* size = csg_argument(node, "size", 0);
    std::vector<double> sides{1, 1};
    if (is_number(size)) {
      sides.assign(2, csg_number(source_, *size));
    } else if (size != nullptr) {
      sides = csg_numbers(source_, *size, 2, 2);
    }
    if (!(sides[0] > 0 && sides[1] > 0)) return {};
    outline = rectangle_outline(sides[0], sides[1], csg_flag(node, "center", 1));
  } else if (node.name == "circle") {
    const double radius = number(node, "r", 0, 1);
    if (!(radius > 0)) return {};
    const std::uint64_t around = fragments(node, radius);
    spend(node, around);
    outline = circle_outline(radius, around);
  } else {
    outline = polygon(node);
  }
  if (outline.contours.empty()) return {};
  return outline;
}

Contour CsgBodies::point_list(const CsgValue& list) const {
  if (list.kind != CsgValue::Kind::list) fail_in_csg(source_, list.at, "needs a list of points");
  Contour points;
  for (const CsgValue& item : list.list) {
    const auto p = csg_numbers(source_, item, 2, 2);
    points.push_back({p[0], p[1]});
  }
  return points;
}

Outline CsgBodies::polygon(const CsgNode& node) const {
  const CsgValue* given = csg_argument(node, "points", 0);
  if (given == nullptr) fail_in_csg(source_, node.at, "needs a list of points");
  const Contour points = point_list(*given);
  std::vector<Contour> contours;
  const CsgValue* paths = csg_argument(node, "paths", 1);
  if (paths != nullptr && paths->kind == CsgValue::Kind::list && !paths->list.empty()) {
    std::vector<CsgValue> one;  // a single path may stand without its own brackets
    const bool bare = paths->list.front().kind == CsgValue::Kind::number;
    if (bare) one.push_back(*paths);
    for (const CsgValue& path : bare ? one : paths->list) {
      Contour& contour = contours.emplace_back();
      for (const std::uint32_t i : index_list(path, points.size())) contour.push_back(points[i]);
    }
  } else {
    contours.push_back(points);
  }
  try {
    return outline_of_paths(std::move(contours));
  } catch (const UnusableInput& error) {
    fail_in_csg(source_, node.at, error.what());
  }
}

// Motions -------------------------------------------------------------------------------------------------------------

std::optional<LinearExtrusion> CsgBodies::linear_extrusion(const CsgNode& node, const Outline& outline) const {
  if (csg_argument(node, "file", 99)) fail_in_csg(source_, node.at, "extruding a file is not supported");
  LinearExtrusion how;
  how.up = {0, 0, number(node, "height", 0, 1)};
  if (const CsgValue* v = csg_argument(node, "v", 99)) {
    const auto up = csg_numbers(source_, *v, 3, 3);
    const Vec3 direction = normalized({up[0], up[1], up[2]});
    how.up = csg_argument(node, "height", 0) ? how.up.z * direction : Vec3{up[0], up[1], up[2]};
  }
  how.center = csg_flag(node, "center", 99);
  how.twist = number(node, "twist", 99, 0);
  if (const CsgValue* scale = csg_argument(node, "scale", 99)) {
    if (is_number(scale)) {
      how.scale.x = how.scale.y = csg_number(source_, *scale);
    } else {
      const auto two = csg_numbers(source_, *scale, 2, 2);
      how.scale = {two[0], two[1]};
    }
    if (how.scale.x < 0 || how.scale.y < 0) fail_in_csg(source_, scale->at, "must not be below 0");
  }
  const double given = number(node, "slices", 99, 0);
  const double slices = given >= 1 ? given : slices_of(how, roundness(node), outline);
  if (!(slices <= max_pieces)) fail_in_csg(source_, node.at, "asks for more than 1,000,000 slices");
  how.slices = static_cast<std::uint64_t>(slices);
  if (!(how.up.z > 0)) return {};
  return how;
}

std::optional<Revolution> CsgBodies::revolution(const CsgNode& node, double reach) const {
  if (csg_argument(node, "file", 99)) fail_in_csg(source_, node.at, "turning a file is not supported");
  Revolution how;
  how.angle = std::clamp(number(node, "angle", 99, 360), -360.0, 360.0);
  if (how.angle == 0) return {};
  const bool ring = std::abs(how.angle) == 360;
  how.start = number(node, "start", 99, ring ? 180 : 0);  // as OpenSCAD has it: a full turn begins on the left
  const auto around = static_cast<double>(fragments(node, reach));
  how.fragments = static_cast<std::uint64_t>(std::max(std::floor(around * std::abs(how.angle) / 360), 1.0));
  return how;
}

FlatOffset CsgBodies::flat_offset(const CsgNode& node) const {
  const bool straight = csg_argument(node, "delta", 99) != nullptr;
  FlatOffset how{.distance = straight ? number(node, "delta", 99, 0) : number(node, "r", 0, 1)};
  if (straight) {
    how.join = csg_flag(node, "chamfer", 99) ? FlatJoin::chamfer : FlatJoin::miter;
  } else if (how.distance != 0) {
    how.fragments = fragments(node, std::abs(how.distance));
  }
  return how;
}

Affine CsgBodies::matrix(const CsgNode& node) const {
  const CsgValue* rows = csg_argument(node, "m", 0);
  if (rows == nullptr || rows->kind != CsgValue::Kind::list || rows->list.size() < 3 || rows->list.size() > 4) {
    fail_in_csg(source_, rows ? rows->at : node.at, "needs a matrix of four rows of four numbers");
  }
  std::vector<std::vector<double>> m;
  for (const CsgValue& row : rows->list) m.push_back(csg_numbers(source_, row, 4, 4));
  if (m.size() == 4 && m[3] != std::vector<double>{0, 0, 0, 1}) {
    fail_in_csg(source_, rows->list[3].at, "needs 0, 0, 0, 1 in its last row; projections are not possible");
  }
  Affine transform;
  for (std::size_t i = 0; i < 3; ++i) transform.column[i] = {m[0][i], m[1][i], m[2][i]};
  transform.translation = {m[0][3], m[1][3], m[2][3]};
  return transform;
}

Mesh CsgBodies::pulled(const CsgNode& node, const Outline& outline, const LinearExtrusion& how) const {
  spend(node, triangles_of(outline, how));
  return extrude(outline, how);
}

Mesh CsgBodies::turned(const CsgNode& node, const Outline& outline, const Revolution& how) const {
  spend(node, triangles_of(outline, how));
  return revolve(outline, how);
}

}  // namespace evenmesh
