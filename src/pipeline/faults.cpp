#include "pipeline/faults.h"

#include <fmt/format.h>

#include <algorithm>

#include "evenmesh/measure.h"
#include "geometry/triangle.h"
#include "measure/triangle_quality.h"

namespace evenmesh {
namespace {

std::optional<std::uint32_t> first_intersecting(const Mesh& mesh, ExecutionContext& context) {
  const auto pairs = self_intersections(mesh, context);
  if (pairs.empty()) return std::nullopt;
  return std::min_element(pairs.begin(), pairs.end())->first;
}

std::optional<std::uint32_t> first_without_area(const Mesh& mesh) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (is_degenerate(mesh, t)) return t;
  return std::nullopt;
}

}  // namespace

std::optional<Vec3> place_of_fault(const Mesh& mesh, FindingCode code, ExecutionContext& context) {
  std::optional<std::uint32_t> triangle;
  if (code == FindingCode::self_intersections) triangle = first_intersecting(mesh, context);
  if (code == FindingCode::no_area) triangle = first_without_area(mesh);
  if (!triangle) return std::nullopt;
  const auto [a, b, c] = corners_of(mesh, *triangle);
  return (a + b + c) / 3;
}

std::string where(const Vec3& place) {
  return fmt::format(", first at ({:.4g}, {:.4g}, {:.4g})", place.x, place.y, place.z);
}

}  // namespace evenmesh
