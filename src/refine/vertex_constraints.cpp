#include "refine/vertex_constraints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "geometry/half_edges.h"
#include "geometry/segment.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

struct CurvePoint {
  Vec3 place;
  double arc = 0;  ///< length of the curve up to there
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

/// Largest distance of the curve between two of its points from the chord; around a closed curve the shorter way.
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

/// Which apexes a place may be within reach of.
class ApexCells {
 public:
  ApexCells(std::span<const Vec3> apexes, double reach) : size_(1.001 * reach) {  // reach beyond what rounding may hide
    for (std::uint32_t a = 0; a < apexes.size(); ++a) {
      const Cell home = cell_of(apexes[a]);
      for (int k = 0; k < 27; ++k)
        apexes_[{home[0] + k % 3 - 1, home[1] + k / 3 % 3 - 1, home[2] + k / 9 - 1}].push_back(a);
    }
  }
  std::span<const std::uint32_t> around(const Vec3& p) const {
    const auto found = apexes_.find(cell_of(p));
    if (found == apexes_.end()) return {};
    return found->second;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& c) const {
      std::uint64_t h = 0;
      for (const std::int64_t x : c) {
        h = (h ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
        h ^= h >> 32;
      }
      return h;
    }
  };
  Cell cell_of(const Vec3& p) const {
    constexpr double most = 1e15;
    Cell cell;
    for (int a = 0; a < 3; ++a)
      cell[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(std::clamp(std::floor(p[a] / size_), -most, most));
    return cell;
  }

  double size_;
  std::unordered_map<Cell, std::vector<std::uint32_t>, Hash> apexes_;
};

class RimFinder {
 public:
  RimFinder(const Mesh& mesh, const VertexConstraints& constraints, const ExecutionContext& context)
      : mesh_(mesh), constraints_(constraints), half_edges_(mesh.triangles, mesh.vertices.size(), context) {}

  bool between_rims(std::uint32_t t) const {
    constexpr double flat = 0.01;  // height by length: of a triangle without area, not of a wall
    const auto [a, b, c] = corners_of(mesh_, t);
    const double longest = std::max({squared_norm(b - a), squared_norm(c - b), squared_norm(a - c)});
    if (norm(area_normal(a, b, c)) < flat * longest) return false;
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      const std::uint32_t beyond = half_edges_.opposite(h);
      if (beyond == HalfEdges::none || !constraints_.edge(origin(h), target(h))) continue;
      if (has_rim(origin(HalfEdges::previous(h)), along(h), normal(beyond / 3))) return true;
    }
    return false;
  }

 private:
  std::uint32_t origin(std::uint32_t h) const { return mesh_.triangles[h / 3][h % 3]; }
  std::uint32_t target(std::uint32_t h) const { return origin(HalfEdges::next(h)); }
  Vec3 along(std::uint32_t h) const { return normalized(mesh_.vertices[target(h)] - mesh_.vertices[origin(h)]); }
  Vec3 normal(std::uint32_t t) const {
    const auto [a, b, c] = corners_of(mesh_, t);
    return normalized(cross(b - a, c - a));
  }
  /// Whether a curve goes through the vertex that way, with a face beside it that looks away.
  bool has_rim(std::uint32_t vertex, const Vec3& way, const Vec3& away) const {
    bool found = false;
    half_edges_.visit_umbrellas(vertex, [&](std::uint32_t h, std::uint32_t) {
      const std::uint32_t back = half_edges_.opposite(h);
      if (found || back == HalfEdges::none || !constraints_.edge(origin(h), target(h))) return;
      const bool looks_away = dot(normal(h / 3), away) < -0.5 || dot(normal(back / 3), away) < -0.5;
      found = looks_away && std::abs(dot(along(h), way)) > 0.9;
    });
    return found;
  }

  const Mesh& mesh_;
  const VertexConstraints& constraints_;
  HalfEdges half_edges_;
};

}  // namespace

std::vector<std::uint32_t> triangles_between_rims(const Mesh& mesh, const VertexConstraints& constraints,
                                                  std::span<const std::uint32_t> triangles,
                                                  const ExecutionContext& context) {
  const RimFinder finder(mesh, constraints, context);
  std::vector<std::uint32_t> found;
  for (const std::uint32_t t : triangles)
    if (finder.between_rims(t)) found.push_back(t);
  return found;
}

std::size_t constrain_apexes(Mesh& mesh, VertexConstraints& constraints, std::span<const Vec3> apexes,
                             double max_distance) {
  if (apexes.empty() || !(max_distance > 0)) return 0;
  if (constraints.curve.empty()) constraints.curve.assign(mesh.vertices.size(), VertexConstraints::free);
  const ApexCells cells(apexes, max_distance);
  std::vector<std::vector<std::uint32_t>> candidates(apexes.size());
  const auto file = [&](std::uint32_t v) {
    for (const std::uint32_t apex : cells.around(mesh.vertices[v])) candidates[apex].push_back(v);
  };
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) file(v);
  std::size_t moved = 0;
  for (std::size_t apex = 0; apex < apexes.size(); ++apex) {
    std::uint32_t nearest = VertexConstraints::free;
    double distance = std::numeric_limits<double>::infinity();
    for (const std::uint32_t v : candidates[apex])
      if (const double d = squared_norm(mesh.vertices[v] - apexes[apex]);
          d < distance || (d == distance && v < nearest)) {
        distance = d;
        nearest = v;
      }
    if (!(std::sqrt(distance) <= max_distance) || constraints.vertex(nearest)) continue;
    constraints.curve[nearest] = VertexConstraints::corner;
    mesh.vertices[nearest] = apexes[apex];
    file(nearest);
    ++moved;
  }
  return moved;
}

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
