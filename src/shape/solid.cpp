#include "evenmesh/solid.h"

#include <algorithm>
#include <cmath>

#include "evenmesh/error.h"
#include "shape/affine_field.h"
#include "shape/bounds.h"
#include "shape/ray_source.h"

namespace evenmesh {
namespace {

void require_solid(const Shape& shape) {
  if (shape.points())
    throw InvalidInput("'" + shape.name +
                       "' is a point cloud and has no inside: make a closed mesh of it first (wrap)");
}

bool is_bounded(const Shape& shape) {
  return !shape.bounds.empty();
}

Shape compound(Compound::Kind kind, std::vector<Shape> operands, double distance, const std::string& name) {
  for (const Shape& operand : operands) require_solid(operand);
  Compound made{kind, std::move(operands), distance};
  std::optional<LengthUnit> unit;
  std::vector<Finding> findings;
  for (const Shape& operand : made.operands) {
    if (!unit) unit = operand.unit;
    for (const Finding& finding : operand.findings) {
      const auto same = [&](const Finding& said) { return said.sentence == finding.sentence; };
      if (std::none_of(findings.begin(), findings.end(), same)) findings.push_back(finding);  // of copies once
    }
  }
  const bool known = kind == Compound::Kind::subtract
                         ? is_bounded(made.operands[0])
                         : std::all_of(made.operands.begin(), made.operands.end(), is_bounded);
  Shape shape{name, {}, std::make_shared<const Compound>(std::move(made)), true};
  if (known) shape.bounds = find_bounds(shape);  // otherwise when it is sampled
  shape.unit = unit;
  shape.findings = std::move(findings);
  return shape;
}

Shape joined(Compound::Kind kind, std::vector<Shape> shapes, const char* name) {
  if (shapes.empty()) throw InvalidInput(std::string(name) + " needs at least one operand");
  if (shapes.size() == 1) {
    require_solid(shapes[0]);
    return std::move(shapes[0]);
  }
  return compound(kind, std::move(shapes), 0, name);
}

}  // namespace

Shape unite(std::vector<Shape> shapes) {
  return joined(Compound::Kind::unite, std::move(shapes), "union");
}
Shape intersect(std::vector<Shape> shapes) {
  return joined(Compound::Kind::intersect, std::move(shapes), "intersection");
}
Shape subtract(Shape from, std::vector<Shape> what) {
  what.insert(what.begin(), std::move(from));
  return joined(Compound::Kind::subtract, std::move(what), "difference");
}

Shape offset(Shape shape, double distance) {
  if (!std::isfinite(distance)) throw InvalidInput("the distance of an offset must be a finite number");
  require_solid(shape);
  if (distance == 0) return shape;
  std::vector<Shape> operand;
  operand.push_back(std::move(shape));
  return compound(Compound::Kind::offset, std::move(operand), distance, "offset");
}

Shape closing(Shape shape, double radius) {
  if (!(radius > 0)) throw InvalidInput("the radius of a closing must be above 0");
  return offset(offset(std::move(shape), radius), -radius);
}
Shape opening(Shape shape, double radius) {
  if (!(radius > 0)) throw InvalidInput("the radius of an opening must be above 0");
  return offset(offset(std::move(shape), -radius), radius);
}

namespace {

/// The factor of a transform that scales all directions alike.
double even_scale(const Affine& transform) {
  const double scale = std::cbrt(std::abs(transform.determinant()));
  for (std::size_t i = 0; i < 3; ++i)
    if (std::abs(norm(transform.column[i]) - scale) > 1e-6 * scale ||
        std::abs(dot(transform.column[i], transform.column[(i + 1) % 3])) > 1e-6 * scale * scale)
      throw InvalidInput("a transform that stretches directions differently cannot follow an offset: put it inside");
  return scale;
}

Shape transformed_compound(const Shape& shape, const Affine& transform) {
  const Compound& old = *shape.compound();
  const double distance = old.kind == Compound::Kind::offset ? old.distance * even_scale(transform) : 0;
  std::vector<Shape> operands;
  for (const Shape& operand : old.operands) operands.push_back(transformed(operand, transform));
  return compound(old.kind, std::move(operands), distance, shape.name);
}

}  // namespace

namespace {

Shape moved_shape(const Shape& shape, const Affine& transform) {
  if (shape.compound()) return transformed_compound(shape, transform);
  if (const PointCloud* given = shape.points()) {
    PointCloud points = *given;
    const Affine back = transform.inverse();
    for (Vec3& p : points.points) p = transform(p);
    for (Vec3& n : points.normals) n = {dot(back.column[0], n), dot(back.column[1], n), dot(back.column[2], n)};
    return shape_from_points(std::move(points), shape.name);
  }
  if (const Mesh* given = shape.mesh()) {
    Mesh mesh = *given;
    for (Vec3& v : mesh.vertices) v = transform(v);
    if (transform.determinant() < 0)
      for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    Shape moved = shape_from_mesh(std::move(mesh), shape.name);
    moved.winding = shape.winding;
    return moved;
  }
  Shape moved = shape;
  if (const RaySource* sampler = shape.ray_source()) {
    moved.bounds = transformed_box(shape.bounds, transform);
    moved.what = sampler->moved(transform);
    return moved;
  }
  auto field = std::get<std::shared_ptr<const Field>>(shape.what);
  // The box that cuts the solid turns with it.
  if (shape.capped_by_bounds && !shape.bounds.empty()) field = boxed_field(std::move(field), shape.bounds);
  moved.bounds = transformed_box(shape.bounds, transform);
  moved.what = transformed_field(std::move(field), transform);
  return moved;
}

}  // namespace

Shape converted(const Shape& shape, LengthUnit unit) {
  const double factor = shape.unit ? conversion_factor(*shape.unit, unit) : 1;
  if (factor == 1) return shape;
  Shape scaled = transformed(shape, {{Vec3{factor, 0, 0}, Vec3{0, factor, 0}, Vec3{0, 0, factor}}, {}});
  scaled.unit = unit;
  scaled.findings.push_back(make_finding(FindingCode::unit_converted, {{"name", shape.name},
                                                                       {"from", std::string(plural_of(*shape.unit))},
                                                                       {"to", std::string(plural_of(unit))},
                                                                       {"factor", factor}}));
  return scaled;
}

Shape transformed(const Shape& shape, const Affine& transform) {
  transform.inverse();  // complains where there is none
  Shape moved = moved_shape(shape, transform);
  moved.unit = shape.unit;
  moved.findings = shape.findings;
  return moved;
}

}  // namespace evenmesh
