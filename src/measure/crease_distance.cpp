#include "measure/crease_distance.h"

#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "geometry/closest_point.h"
#include "geometry/half_edges.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

constexpr double sharp = 40, sharp_enough = 20;  ///< degrees

/// The edges that turn by more than `angle` degrees, each as a triangle without width.
Mesh edges_sharper_than(const Mesh& mesh, double angle) {
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  const double cosine = std::cos(angle * std::numbers::pi / 180);
  const auto normal = [&](std::size_t half_edge) {
    const auto [a, b, c] = corners_of(mesh, half_edge / 3);
    return normalized(area_normal(a, b, c));
  };
  Mesh lines;
  for (std::size_t h = 0; h < 3 * mesh.triangles.size(); ++h) {
    const std::uint32_t o = edges.opposite(h);
    if (o == HalfEdges::none || o < h || dot(normal(h), normal(o)) >= cosine) continue;
    const auto at = static_cast<std::uint32_t>(lines.vertices.size());
    const Triangle& t = mesh.triangles[h / 3];
    lines.vertices.push_back(mesh.vertices[t[h % 3]]);
    lines.vertices.push_back(mesh.vertices[t[(h + 1) % 3]]);
    lines.triangles.push_back({at, at + 1, at + 1});
  }
  return lines;
}

}  // namespace

CreaseDistance crease_distance(const Mesh& of, const Mesh& to, double step, ExecutionContext& context) {
  const Mesh from = edges_sharper_than(of, sharp), lines = edges_sharper_than(to, sharp_enough);
  CreaseDistance result;
  for (const Triangle& t : from.triangles) result.length += norm(from.vertices[t[1]] - from.vertices[t[0]]);
  if (from.triangles.empty()) return result;
  if (lines.triangles.empty()) {
    result.largest = result.mean = std::numeric_limits<double>::infinity();
    return result;
  }
  const SurfaceQuery query(lines, context);
  struct Tally {
    double largest = 0, sum = 0;
  };
  std::vector<Tally> of_edge(from.triangles.size());  // the sum is an integral along the edge
  parallel_for(context, of_edge.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const Vec3 a = from.vertices[2 * e], along = from.vertices[2 * e + 1] - a;
      const int pieces = static_cast<int>(std::clamp(std::ceil(norm(along) / step), 1.0, 1e6));
      for (int i = 0; i <= pieces; ++i) {
        const double distance = std::sqrt(query.closest(a + (double(i) / pieces) * along).squared_distance);
        of_edge[e].largest = std::max(of_edge[e].largest, distance);
        of_edge[e].sum += (i == 0 || i == pieces ? 0.5 : 1.0) * distance * norm(along) / pieces;
      }
    }
  });
  double sum = 0;
  for (const Tally& tally : of_edge) {
    result.largest = std::max(result.largest, tally.largest);
    sum += tally.sum;
  }
  result.mean = result.length > 0 ? sum / result.length : 0;
  return result;
}

double mean_edge_length(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c) sum += norm(mesh.vertices[t[(c + 1) % 3]] - mesh.vertices[t[c]]);
  return mesh.triangles.empty() ? 0 : sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

}  // namespace evenmesh
