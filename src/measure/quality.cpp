#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "evenmesh/measure.h"
#include "geometry/triangle.h"
#include "measure/topology.h"
#include "measure/triangle_quality.h"

namespace evenmesh {
namespace {

/// Sums over a range of triangles.
struct Sums {
  double q_min = 1, q_sum = 0, theta_min = 180, theta_max = 0, theta_sum = 0, area = 0, volume = 0;
  std::size_t below_30 = 0, degenerate = 0;

  void add(const Mesh& mesh, std::size_t triangle, const Vec3& origin) {
    const auto [a, b, c] = corners_of(mesh, triangle);
    const TriangleQuality t = triangle_quality(a, b, c);
    q_min = std::min(q_min, t.q);
    q_sum += t.q;
    theta_min = std::min(theta_min, t.smallest_angle);
    theta_sum += t.smallest_angle;
    theta_max = std::max(theta_max, t.largest_angle);
    below_30 += t.smallest_angle < 30;
    area += t.area;
    volume += dot(a - origin, cross(b - origin, c - origin)) / 6;
    // Rounding leaves the sine of an angle uncertain by far less than this: only then the exact test is worth its time.
    degenerate += t.smallest_angle < 1e-5 && is_degenerate(mesh, triangle);
  }
  void add(const Sums& s) {
    q_min = std::min(q_min, s.q_min);
    q_sum += s.q_sum;
    theta_min = std::min(theta_min, s.theta_min);
    theta_sum += s.theta_sum;
    theta_max = std::max(theta_max, s.theta_max);
    area += s.area;
    volume += s.volume;
    below_30 += s.below_30;
    degenerate += s.degenerate;
  }
};

/// In pieces of fixed size, merged in order: the same bits for any number of threads.
Sums sum_triangles(const Mesh& mesh, const ExecutionContext& context) {
  constexpr std::size_t piece = 4096;
  const Vec3 origin = mesh.vertices[mesh.triangles[0][0]];
  std::vector<Sums> pieces((mesh.triangles.size() + piece - 1) / piece);
  parallel_tasks(context, pieces.size(), [&](std::size_t i) {
    const std::size_t end = std::min((i + 1) * piece, mesh.triangles.size());
    for (std::size_t t = i * piece; t < end; ++t) pieces[i].add(mesh, t, origin);
  });
  Sums total;
  for (const Sums& s : pieces) total.add(s);
  return total;
}

void put_shapes(const Sums& sums, MeshQuality& q) {
  const auto faces = static_cast<double>(q.faces);
  q.q_min = sums.q_min;
  q.q_avg = sums.q_sum / faces;
  q.theta_min = sums.theta_min;
  q.theta_avg = sums.theta_sum / faces;
  q.theta_max = sums.theta_max;
  q.below_30_ratio = static_cast<double>(sums.below_30) / faces;
  q.area = sums.area;
  q.volume = sums.volume;
  q.degenerate_faces = sums.degenerate;
}

void put_topology(const Topology& topology, MeshQuality& q) {
  std::size_t interior = 0, irregular = 0;
  for (const VertexState& v : topology.vertices) {
    if (!v.used) {
      ++q.unused_vertices;
      continue;
    }
    ++q.vertices;
    q.max_valence = std::max<std::size_t>(q.max_valence, v.valence);
    if (!v.on_boundary) {
      ++interior;
      irregular += v.valence != 6;
    }
    q.non_manifold_vertices += v.umbrellas > 1 || v.on_non_manifold_edge;
  }
  q.irregular_ratio = interior > 0 ? static_cast<double>(irregular) / static_cast<double>(interior) : 0;
  q.boundary_edges = topology.boundary;
  q.non_manifold_edges = topology.non_manifold;
  q.inconsistent_edges = topology.inconsistent;
  q.components = topology.components;
  q.euler = static_cast<std::int64_t>(q.vertices + q.faces) - static_cast<std::int64_t>(topology.edges);
  const auto edges = static_cast<double>(topology.edges);
  q.edge_length_avg = topology.length_sum / edges;
  const double variance = topology.length_squares / edges - q.edge_length_avg * q.edge_length_avg;
  q.edge_length_cv = q.edge_length_avg > 0 ? std::sqrt(std::max(0.0, variance)) / q.edge_length_avg : 0;
}

}  // namespace

MeshQuality measure_quality(const Mesh& mesh, ExecutionContext& context) {
  MeshQuality q;
  q.faces = mesh.triangles.size();
  q.bounds = mesh.bounds();
  if (mesh.triangles.empty()) {
    q.unused_vertices = mesh.vertices.size();
    return q;
  }
  with_threads(context, [&] {
    Topology topology;
    Sums sums;
    // The two do not depend on each other.
    parallel_tasks(context, 2, [&](std::size_t i) {
      if (i == 0)
        topology = measure_topology(mesh);
      else
        sums = sum_triangles(mesh, context);
    });
    put_shapes(sums, q);
    put_topology(topology, q);
  });
  return q;
}

}  // namespace evenmesh
