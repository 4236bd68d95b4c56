#include "refine/vertex_constraints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/segment.h"

namespace evenmesh {
namespace {

struct CurvePoint {
  Vec3 place;
  double arc = 0;  ///< length of the chain up to there
};

CurvePoint nearest_on(const FeatureCurve& curve, const Vec3& p) {
  const std::vector<Vec3>& points = curve.points;
  double nearest = std::numeric_limits<double>::infinity();
  CurvePoint best{points.front(), 0};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const SegmentPoint on = closest_point_on_segment(p, points[i], points[i + 1]);
    if (on.squared_distance >= nearest) continue;
    nearest = on.squared_distance;
    best = {on.point, curve.arc[i] + on.share * (curve.arc[i + 1] - curve.arc[i])};
  }
  return best;
}

/// Largest distance of the chain between two of its points from the chord; around a closed chain the shorter way.
double deviation_between(const FeatureCurve& curve, const Vec3& p, const Vec3& q) {
  const auto [s, t] = std::minmax({nearest_on(curve, p).arc, nearest_on(curve, q).arc});
  const bool around = curve.points.front() == curve.points.back() && 2 * (t - s) > curve.length();
  double most = 0;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    if ((curve.arc[i] > s && curve.arc[i] < t) == around) continue;
    most = std::max(most, closest_point_on_segment(curve.points[i], p, q).squared_distance);
  }
  return std::sqrt(most);
}

}  // namespace

bool VertexConstraints::edge(std::uint32_t a, std::uint32_t b) const {
  return vertex(a) && vertex(b) &&
         std::binary_search(edges.begin(), edges.end(), std::array{std::min(a, b), std::max(a, b)});
}

void VertexConstraints::release(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
  if (curve.empty()) return;
  for (const std::uint32_t t : triangles)
    for (const std::uint32_t v : mesh.triangles[t]) curve[v] = free;
}

Vec3 VertexConstraints::slide(std::uint32_t v, const Vec3& p) const {
  return nearest_on(features.curves[curve[v]], p).place;
}

double VertexConstraints::chordal_deviation(const Mesh& mesh, std::uint32_t v,
                                            std::span<const std::uint32_t> neighbours) const {
  double most = 0;
  for (const std::uint32_t w : neighbours)
    if (edge(v, w))
      most = std::max(most, deviation_between(features.curves[curve[v]], mesh.vertices[v], mesh.vertices[w]));
  return most;
}

}  // namespace evenmesh
