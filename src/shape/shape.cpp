#include "evenmesh/shape.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "evenmesh/error.h"
#include "geometry/primitives.h"
#include "shape/expression.h"
#include "shape/expression_field.h"
#include "shape/field.h"

namespace evenmesh {
namespace {

void require_usable_bounds(const Box& box) {
  if (box.empty() || !is_finite(box.lo) || !is_finite(box.hi) || box.lo.x == box.hi.x || box.lo.y == box.hi.y ||
      box.lo.z == box.hi.z)
    throw InvalidInput("the bounds are empty; give a box with x0 < x1, y0 < y1 and z0 < z1");
}

/// @param what  of `name`, e.g. "point"
void require_finite(const std::vector<Vec3>& vectors, const char* what, const std::string& name) {
  const auto wrong = std::find_if_not(vectors.begin(), vectors.end(), is_finite);
  if (wrong == vectors.end()) return;
  throw InvalidInput(what + (" " + std::to_string(wrong - vectors.begin())) + " of '" + name +
                     "' has a coordinate that is not finite");
}

/// −1 where a function says inside, 1 elsewhere.
class Indicator final : public Field {
 public:
  explicit Indicator(std::function<bool(const Vec3&)> inside) : inside_(std::move(inside)) {}

  void evaluate(const PointBatch& points, std::span<float> values) const override {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = inside_(Vec3{points.x[i], points.y[i], points.z[i]}) ? -1.0f : 1.0f;
  }

  void evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx, std::span<float> dy,
                         std::span<float> dz) const override {
    evaluate(points, values);
    for (const std::span<float> derivative : {dx, dy, dz}) std::fill(derivative.begin(), derivative.end(), 0.0f);
  }

  Interval evaluate(const Box&) const override { return {-1, 1}; }

  double evaluate(const Vec3& point, Vec3* gradient) const override {
    if (gradient) *gradient = {};
    return inside_(point) ? -1 : 1;
  }

  bool has_gradient() const override { return false; }
  bool is_precise() const override { return true; }

 private:
  std::function<bool(const Vec3&)> inside_;
};

/// A density that remembers what it was made of.
struct ExpressionDensity {
  DensityExpression made_of;
  Shape shape;
  double operator()(const Vec3& p) const { return shape.field()->evaluate(p, nullptr); }
};

}  // namespace

Shape shape_from_mesh(Mesh mesh, std::string name) {
  if (mesh.triangles.empty()) throw UnusableInput("'" + name + "' has no triangle, so it bounds no solid");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v >= mesh.vertices.size())
        throw InvalidInput("triangle " + std::to_string(t) + " of '" + name + "' uses vertex " + std::to_string(v) +
                           ", but there are only " + std::to_string(mesh.vertices.size()) + " vertices (from 0)");
      if (!is_finite(mesh.vertices[v]))
        throw InvalidInput("vertex " + std::to_string(v) + " of '" + name + "' has a coordinate that is not finite");
    }
  }
  const Box bounds = mesh.bounds();
  const std::optional<LengthUnit> unit = mesh.unit;
  Shape shape{std::move(name), bounds, std::make_shared<const Mesh>(std::move(mesh)), false};
  shape.unit = unit;
  return shape;
}

Shape shape_from_points(PointCloud points, std::string name) {
  if (points.points.empty()) throw UnusableInput("'" + name + "' has no point, so it shows no surface");
  if (!points.normals.empty() && points.normals.size() != points.points.size())
    throw InvalidInput("'" + name + "' has " + std::to_string(points.normals.size()) + " normals for " +
                       std::to_string(points.points.size()) + " points; give one for each, or none");
  require_finite(points.points, "point", name);
  require_finite(points.normals, "normal", name);
  const Box bounds = points.bounds();
  return Shape{std::move(name), bounds, std::make_shared<const PointCloud>(std::move(points)), false};
}

Shape shape_from_expression(std::string_view expression, const std::map<std::string, double>& parameters,
                            const Box& bounds) {
  const bool bounded = bounds != Box{};
  if (bounded) require_usable_bounds(bounds);
  return Shape{std::string(expression), bounds, make_graph_field(parse_expression(expression, parameters)), bounded};
}

Density density_from_expression(std::string_view expression, const std::map<std::string, double>& parameters) {
  const Shape shape = shape_from_expression(expression, parameters, {{-1, -1, -1}, {1, 1, 1}});
  return ExpressionDensity{{std::string(expression), parameters}, shape};
}

std::optional<DensityExpression> expression_of(const Density& density) {
  const auto* made = density.target<ExpressionDensity>();
  if (made == nullptr) return std::nullopt;
  return made->made_of;
}

Shape shape_from_box(const Box& box, std::string name) {
  require_usable_bounds(box);
  return shape_from_mesh(make_box_around(box), std::move(name));
}

Shape shape_from_indicator(std::function<bool(const Vec3&)> inside, const Box& bounds, std::string name) {
  require_usable_bounds(bounds);
  if (!inside) throw InvalidInput("'" + name + "': the indicator function is missing");
  return Shape{std::move(name), bounds, std::make_shared<const Indicator>(std::move(inside)), true};
}

}  // namespace evenmesh
