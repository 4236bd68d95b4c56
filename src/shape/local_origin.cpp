#include "shape/local_origin.h"

#include <algorithm>
#include <cmath>

#include "evenmesh/solid.h"
#include "shape/affine_field.h"
#include "shape/ray_source.h"

namespace evenmesh {
namespace {

constexpr double far_away = 8;  ///< longest sides: from here on coordinates cost more than three bits of precision

Shape counted_within(const Vec3& origin, const Shape& shape, const Box& where);

/// What a shape is, counted from the origin. @param where  it is sampled, counted so
struct Shift {
  const Vec3& origin;
  const Box& where;

  using What = decltype(Shape::what);
  What operator()(const std::shared_ptr<const Mesh>& given) const {
    Mesh mesh = *given;
    for (Vec3& v : mesh.vertices) v -= origin;
    return std::make_shared<const Mesh>(std::move(mesh));
  }
  What operator()(const std::shared_ptr<const PointCloud>& given) const {
    PointCloud points = *given;
    for (Vec3& p : points.points) p -= origin;
    return std::make_shared<const PointCloud>(std::move(points));
  }
  What operator()(const std::shared_ptr<const Field>& field) const { return shifted_field(field, origin, where); }
  What operator()(const std::shared_ptr<const RaySource>& source) const {
    return source->moved(Affine::translate(-origin));
  }
  What operator()(const std::shared_ptr<const Compound>& given) const {
    Compound compound{given->kind, {}, given->distance};
    for (const Shape& operand : given->operands) compound.operands.push_back(counted_within(origin, operand, where));
    return std::make_shared<const Compound>(std::move(compound));
  }
};

Shape counted_within(const Vec3& origin, const Shape& shape, const Box& where) {
  Shape counted = shape;
  if (!shape.bounds.empty()) counted.bounds = {shape.bounds.lo - origin, shape.bounds.hi - origin};
  counted.what = std::visit(Shift{origin, where}, shape.what);
  return counted;
}

double rounding_within(const Shape& shape, const Vec3& origin, const Box& where) {
  if (const Field* field = shape.field()) return rounding_of(*field, where);
  if (shape.ray_source() && origin != Vec3{}) return single_rounding({where.lo + origin, where.hi + origin});
  const Compound* compound = shape.compound();
  if (!compound) return 0;
  double most = 0;
  for (const Shape& operand : compound->operands) most = std::max(most, rounding_within(operand, origin, where));
  return most;
}

}  // namespace

Vec3 local_origin(const Box& box) {
  const double size = box.longest_side();
  if (!(size > 0) || !std::isfinite(size)) return {};
  const double step = std::exp2(std::ceil(std::log2(size)));
  Vec3 origin;
  for (int a = 0; a < 3; ++a) {
    const double middle = box.center()[a];
    if (std::abs(middle) > far_away * size) origin[a] = step * std::round(middle / step);
  }
  return origin;
}

double single_rounding(const Box& box) {
  double farthest = 0;
  for (int a = 0; a < 3; ++a) farthest = std::max({farthest, std::abs(box.lo[a]), std::abs(box.hi[a])});
  return std::ldexp(farthest, -24);
}

Shape counted_from(const Vec3& origin, const Shape& shape) {
  return counted_within(origin, shape, {shape.bounds.lo - origin, shape.bounds.hi - origin});
}

double rounding_of(const Shape& shape, const Vec3& origin) {
  return rounding_within(shape, origin, shape.bounds);
}

}  // namespace evenmesh
