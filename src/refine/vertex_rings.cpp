#include "refine/vertex_rings.h"

namespace evenmesh {

VertexRings::VertexRings(const Mesh& mesh)
    : mesh_(mesh), start_(mesh.vertices.size() + 1, 0), around_(3 * mesh.triangles.size()) {
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) ++start_[v + 1];
  for (std::size_t v = 0; v + 1 < start_.size(); ++v) start_[v + 1] += start_[v];
  std::vector<std::uint32_t> fill(start_.begin(), start_.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) around_[fill[v]++] = static_cast<std::uint32_t>(t);
}

Vec3 VertexRings::normal(std::uint32_t v) const {
  Vec3 sum;
  for (const std::uint32_t t : triangles(v)) {
    const Triangle& c = mesh_.triangles[t];
    sum += cross(mesh_.vertices[c[1]] - mesh_.vertices[c[0]], mesh_.vertices[c[2]] - mesh_.vertices[c[0]]);
  }
  return normalized(sum);
}

double VertexRings::edge_length(std::uint32_t v) const {
  double sum = 0;
  for (const std::uint32_t t : triangles(v))
    for (int c = 0; c < 3; ++c)
      sum += norm(mesh_.vertices[mesh_.triangles[t][(c + 1) % 3]] - mesh_.vertices[mesh_.triangles[t][c]]);
  return sum / (3.0 * static_cast<double>(triangles(v).size()));
}

std::vector<Vec3> VertexRings::normals(std::uint32_t v) const {
  std::vector<Vec3> list;
  for (const std::uint32_t t : triangles(v)) list.push_back(normal_of(mesh_.triangles[t]));
  return list;
}

double VertexRings::worst_score(std::uint32_t v, std::span<const Vec3> normals_before) const {
  double worst = 2;
  const auto around = triangles(v);
  for (std::size_t i = 0; i < around.size(); ++i) {
    const Triangle& t = mesh_.triangles[around[i]];
    worst = std::min(worst, score(t));
    if (dot(normal_of(t), normals_before[i]) < 0.34) return -1;
  }
  return worst;
}

double VertexRings::score(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double x = norm(b - a), y = norm(c - b), z = norm(a - c);
  const double longest = std::max({x, y, z}), shortest = std::min({x, y, z}), middle = x + y + z - longest - shortest;
  const double twice_area = norm(cross(b - a, c - a));
  if (!(shortest > 0)) return 0;
  const double quality = 6 * twice_area / (std::numbers::sqrt3 * (x + y + z) * longest);
  const double angle = std::asin(std::min(1.0, twice_area / (middle * longest))) * 180 / std::numbers::pi;
  return std::min(quality / 0.72, angle / 38);
}

}  // namespace evenmesh
