#include "refine/reference_points.h"

#include <algorithm>
#include <limits>

#include "core/parallel.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

constexpr std::uint32_t none = EditableMesh::none;
constexpr double projection_limit = 0.5;  ///< of an edge
constexpr double least_cosine = 0.3;      ///< between the normals of the surface and of a triangle there

}  // namespace

struct ReferencePoints::Corners {
  Corners(const EditableMesh& mesh, std::uint32_t t)
      : a(mesh.position(mesh.origin(3 * t))),
        b(mesh.position(mesh.origin(3 * t + 1))),
        c(mesh.position(mesh.origin(3 * t + 2))),
        middle((1.0 / 3) * (a + b + c)),
        normal(normalized(area_normal(a, b, c))),
        radius(std::sqrt(std::max({squared_norm(a - middle), squared_norm(b - middle), squared_norm(c - middle)}))),
        triangle(t) {}
  Vec3 a, b, c, middle, normal;
  double radius;  ///< around the middle
  std::uint32_t triangle;
};

ReferencePoints::ReferencePoints(const EditableMesh& mesh, const Projector* projector, const ExecutionContext& context)
    : projector_(projector), first_(mesh.triangle_slots(), none) {
  std::vector<Vec3> middles(mesh.triangle_slots());
  std::vector<double> distances(middles.size(), 0);
  parallel_for(context, middles.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (auto t = static_cast<std::uint32_t>(begin); t < end; ++t) {
      if (!mesh.triangle_in_use(t)) continue;
      const Corners c(mesh, t);
      middles[t] = projector ? projector->project(c.middle, projection_limit * norm(c.b - c.a)) : c.middle;
      distances[t] = squared_norm(closest_point_on_triangle(middles[t], c.a, c.b, c.c) - middles[t]);
    }
  });
  for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v)
    if (mesh.vertex_in_use(v)) add(mesh.position(v), {}, 0, mesh.outgoing(v) / 3);
  for (std::uint32_t t = 0; t < middles.size(); ++t)
    if (mesh.triangle_in_use(t)) add(middles[t], Corners(mesh, t).normal, distances[t], t);
}

void ReferencePoints::add(const Vec3& p, const Vec3& normal, double squared_distance, std::uint32_t triangle) {
  next_.push_back(first_[triangle]);
  first_[triangle] = static_cast<std::uint32_t>(points_.size());
  points_.push_back(p);
  normals_.push_back(normal);
  squared_distance_.push_back(squared_distance);
}

ReferencePoints::Nearest ReferencePoints::nearest(std::uint32_t point, std::span<const Corners> candidates,
                                                  std::size_t guess) const {
  const Vec3 &p = points_[point], &normal = normals_[point];
  const bool any_side = normal == Vec3{};
  Nearest best;
  double distance = std::numeric_limits<double>::infinity();
  const auto look_at = [&](const Corners& c) {
    const double reach = distance + c.radius;
    if (squared_norm(p - c.middle) > reach * reach) return;
    if (!any_side && !(dot(normal, c.normal) > least_cosine)) return;
    const double d = squared_norm(closest_point_on_triangle(p, c.a, c.b, c.c) - p);
    if (d >= best.squared_distance) return;
    best = {d, c.triangle};
    distance = std::sqrt(d);
  };
  if (guess < candidates.size()) look_at(candidates[guess]);
  for (const Corners& c : candidates) look_at(c);
  return best;
}

bool ReferencePoints::near_surface(const EditableMesh& mesh, std::uint32_t triangle, double squared_distance) const {
  if (!projector_) return true;
  const Vec3 middle = Corners(mesh, triangle).middle;
  const Vec3 on_surface = projector_->project(middle, 8 * std::sqrt(squared_distance));
  return squared_norm(on_surface - middle) <= squared_distance;
}

bool ReferencePoints::hand_over(const EditableMesh& mesh, std::span<const std::uint32_t> before,
                                std::span<const std::uint32_t> now, std::span<const std::uint32_t> changed,
                                double tolerance) {
  std::vector<Corners> candidates;
  for (const std::uint32_t t : now) candidates.emplace_back(mesh, t);
  const auto candidate = [&](std::uint32_t t) {
    const auto at = std::lower_bound(now.begin(), now.end(), t);
    return static_cast<std::size_t>(at != now.end() && *at == t ? at - now.begin() : 0);
  };
  double most = tolerance * tolerance;
  for (const std::uint32_t t : before)
    for (std::uint32_t i = first_[t]; i != none; i = next_[i]) most = std::max(most, squared_distance_[i]);
  std::vector<std::uint32_t> points;
  std::vector<Nearest> found;
  for (const std::uint32_t t : before)
    for (std::uint32_t i = first_[t]; i != none; i = next_[i]) {
      points.push_back(i);
      found.push_back(nearest(i, candidates, candidate(t)));
      if (!(found.back().squared_distance <= most)) return false;
    }
  for (const std::uint32_t t : changed)
    if (!near_surface(mesh, t, most)) return false;
  for (const std::uint32_t t : before) first_[t] = none;
  for (std::size_t i = 0; i < points.size(); ++i) {
    squared_distance_[points[i]] = found[i].squared_distance;
    next_[points[i]] = first_[found[i].triangle];
    first_[found[i].triangle] = points[i];
  }
  return true;
}

}  // namespace evenmesh
