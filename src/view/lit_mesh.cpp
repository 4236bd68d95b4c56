#include "view/lit_mesh.h"

#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

constexpr double crease_cosine = 0.75;  // beyond some 41° between triangle and vertex normal there is a crease
constexpr double reach = 0.5;           // occluders count up to this distance, in units of the mesh's diagonal
constexpr float start = 2e-3f;          // leaves out the surface itself, in the same unit

/// Angle-weighted (Thürmer, Wüthrich, Computing vertex normals from polygonal facets, JGT 1998).
std::vector<Vec3> vertex_normals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto c = corners_of(mesh, t);
    const Vec3 normal = normalized(area_normal(c[0], c[1], c[2]));
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = c[(k + 1) % 3] - c[k], v = c[(k + 2) % 3] - c[k];
      normals[mesh.triangles[t][k]] += std::atan2(norm(cross(u, v)), dot(u, v)) * normal;
    }
  }
  for (Vec3& n : normals) n = normalized(n);
  return normals;
}

/// Directions spread evenly over the sphere (Fibonacci lattice).
std::vector<Vec3> spread_directions(int count) {
  std::vector<Vec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z),
                 a = 2 * std::numbers::pi * i / std::numbers::phi;
    directions.push_back({r * std::cos(a), r * std::sin(a), z});
  }
  return directions;
}

/// Cosine-weighted share of the directions above the surface that meet nothing. All vertices use the same directions:
/// no noise between neighbours.
float openness_at(const Vec3& local, const Vec3& normal, const std::vector<Vec3>& directions, RTCScene scene) {
  double open = 0, all = 0;
  for (const Vec3& d : directions) {
    const double cosine = dot(d, normal);
    if (cosine <= 0.05) continue;
    RTCRay ray{};
    const Vec3 from = local + static_cast<double>(start) * normal;
    ray.org_x = static_cast<float>(from.x);
    ray.org_y = static_cast<float>(from.y);
    ray.org_z = static_cast<float>(from.z);
    ray.dir_x = static_cast<float>(d.x);
    ray.dir_y = static_cast<float>(d.y);
    ray.dir_z = static_cast<float>(d.z);
    ray.tnear = start;
    ray.tfar = static_cast<float>(reach);
    ray.mask = ~0u;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
    all += cosine;
    if (ray.tfar >= 0) open += cosine;
  }
  return all > 0 ? static_cast<float>(open / all) : 1.0f;
}

}  // namespace

std::array<Vec3, 3> LitMesh::corner_normals(const Mesh& mesh, std::size_t triangle) const {
  const auto [a, b, c] = corners_of(mesh, triangle);
  const Vec3 own = normalized(area_normal(a, b, c));
  std::array<Vec3, 3> result;
  for (int k = 0; k < 3; ++k) {
    const Vec3& n = normals[mesh.triangles[triangle][k]];
    result[k] = dot(n, own) > crease_cosine ? n : own;
  }
  return result;
}

LitMesh light_mesh(const Mesh& mesh, const ExecutionContext& context) {
  LitMesh lit{EmbreeScene(mesh, context), vertex_normals(mesh), std::vector<float>(mesh.vertices.size())};
  // Large meshes make do with fewer rays: their neighbours lie closer.
  const std::size_t count = std::clamp<std::size_t>(6'000'000 / mesh.vertices.size(), 32, 160);
  const std::vector<Vec3> directions = spread_directions(static_cast<int>(count));
  with_threads(context, [&] {
    parallel_for(context, mesh.vertices.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        lit.openness[v] =
            openness_at(lit.scene.to_local(mesh.vertices[v]), lit.normals[v], directions, lit.scene.handle());
    });
  });
  return lit;
}

}  // namespace evenmesh
