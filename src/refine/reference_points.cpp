#include "refine/reference_points.h"

#include <algorithm>
#include <limits>

#include "core/parallel.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

constexpr std::uint32_t none = EditableMesh::none;
constexpr double projection_limit = 0.5;  ///< of an edge

struct Corners {
  Vec3 a, b, c, middle;
  double radius;
  std::uint32_t triangle;
};

Corners corners_of_triangle(const EditableMesh& mesh, std::uint32_t t) {
  const Vec3 &a = mesh.position(mesh.origin(3 * t)), &b = mesh.position(mesh.origin(3 * t + 1)),
             &c = mesh.position(mesh.origin(3 * t + 2));
  const Vec3 middle = (1.0 / 3) * (a + b + c);
  const double radius =
      std::sqrt(std::max({squared_norm(a - middle), squared_norm(b - middle), squared_norm(c - middle)}));
  return {a, b, c, middle, radius, t};
}

}  // namespace

ReferencePoints::ReferencePoints(const EditableMesh& mesh, const Projector* projector, const ExecutionContext& context)
    : first_(mesh.triangle_slots(), none) {
  std::vector<Vec3> middles(mesh.triangle_slots());
  std::vector<double> distances(middles.size(), 0);
  parallel_for(context, middles.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (auto t = static_cast<std::uint32_t>(begin); t < end; ++t) {
      if (!mesh.triangle_in_use(t)) continue;
      const Corners c = corners_of_triangle(mesh, t);
      middles[t] = projector ? projector->project(c.middle, projection_limit * norm(c.b - c.a)) : c.middle;
      distances[t] = squared_norm(closest_point_on_triangle(middles[t], c.a, c.b, c.c) - middles[t]);
    }
  });
  for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v)
    if (mesh.vertex_in_use(v)) add(mesh.position(v), 0, mesh.outgoing(v) / 3);
  for (std::uint32_t t = 0; t < middles.size(); ++t)
    if (mesh.triangle_in_use(t)) add(middles[t], distances[t], t);
}

void ReferencePoints::add(const Vec3& p, double squared_distance, std::uint32_t triangle) {
  next_.push_back(first_[triangle]);
  first_[triangle] = static_cast<std::uint32_t>(points_.size());
  points_.push_back(p);
  squared_distance_.push_back(squared_distance);
}

bool ReferencePoints::hand_over(const EditableMesh& mesh, std::span<const std::uint32_t> before,
                                std::span<const std::uint32_t> now, double tolerance) {
  std::vector<Corners> candidates;
  for (const std::uint32_t t : now)
    if (mesh.triangle_in_use(t)) candidates.push_back(corners_of_triangle(mesh, t));
  std::vector<std::uint32_t> points;
  double most = tolerance * tolerance;
  for (const std::uint32_t t : before)
    for (std::uint32_t i = first_[t]; i != none; i = next_[i]) {
      points.push_back(i);
      most = std::max(most, squared_distance_[i]);
    }
  struct Found {
    double squared_distance = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = none;
  };
  std::vector<Found> found(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points_[points[i]];
    double bound = std::numeric_limits<double>::infinity();  // the nearest middle is no nearer than the triangle
    for (const Corners& c : candidates) bound = std::min(bound, squared_norm(p - c.middle));
    for (const Corners& c : candidates) {
      const double reach = std::sqrt(std::min(bound, found[i].squared_distance)) + c.radius;
      if (squared_norm(p - c.middle) > reach * reach) continue;
      const double d = squared_norm(closest_point_on_triangle(p, c.a, c.b, c.c) - p);
      if (d < found[i].squared_distance) found[i] = {d, c.triangle};
    }
    if (found[i].triangle == none || found[i].squared_distance > most) return false;
  }
  for (const std::uint32_t t : before) first_[t] = none;
  for (std::size_t i = 0; i < points.size(); ++i) {
    squared_distance_[points[i]] = found[i].squared_distance;
    next_[points[i]] = first_[found[i].triangle];
    first_[found[i].triangle] = points[i];
  }
  return true;
}

}  // namespace evenmesh
