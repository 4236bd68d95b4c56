#include "refine/vertex_rings.h"

#include <algorithm>

namespace evenmesh {

VertexRings::VertexRings(const Mesh& mesh)
    : mesh_(mesh), start_(mesh.vertices.size() + 1, 0), around_(3 * mesh.triangles.size()) {
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) ++start_[v + 1];
  for (std::size_t v = 0; v + 1 < start_.size(); ++v) start_[v + 1] += start_[v];
  std::vector<std::uint32_t> fill(start_.begin(), start_.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) around_[fill[v]++] = static_cast<std::uint32_t>(t);
  beside_start_.push_back(0);
  beside_.reserve(around_.size());
  for (std::uint32_t v = 0; v + 1 < start_.size(); ++v) {
    const auto first = static_cast<std::ptrdiff_t>(beside_.size());
    for (const std::uint32_t t : triangles(v))
      for (const std::uint32_t w : mesh.triangles[t])
        if (w != v && std::find(beside_.begin() + first, beside_.end(), w) == beside_.end()) beside_.push_back(w);
    beside_start_.push_back(static_cast<std::uint32_t>(beside_.size()));
  }
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

void VertexRings::normals(std::uint32_t v, std::vector<Vec3>& list) const {
  list.clear();
  for (const std::uint32_t t : triangles(v)) list.push_back(normal_of(mesh_.triangles[t]));
}

namespace {

double score_of(double x, double y, double z, double twice_area) {
  const double longest = std::max({x, y, z}), shortest = std::min({x, y, z}), middle = x + y + z - longest - shortest;
  if (!(shortest > 0)) return 0;
  constexpr double good_quality = 0.7, sine_of_good_angle = 0.6156614753256583;  // 38°
  const double quality = 6 * twice_area / (std::numbers::sqrt3 * (x + y + z) * longest);
  const double sine = twice_area / (middle * longest);
  return std::min(quality / good_quality, sine / sine_of_good_angle);
}

}  // namespace

double VertexRings::worst_score(std::uint32_t v, std::span<const Vec3> normals_before, double least) const {
  double worst = 2;
  const auto around = triangles(v);
  for (std::size_t i = 0; i < around.size() && worst > least; ++i) {
    const Triangle& t = mesh_.triangles[around[i]];
    const Vec3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
    const Vec3 normal = cross(b - a, c - a);
    const double twice_area = norm(normal);
    if (dot(normal, normals_before[i]) < 0.34 * twice_area) return -1;
    worst = std::min(worst, score_of(norm(b - a), norm(c - b), norm(a - c), twice_area));
  }
  return worst;
}

std::vector<std::uint32_t> triangles_below(const Mesh& mesh, double least) {
  std::vector<std::uint32_t> list;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    if (VertexRings::score(mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]) < least) list.push_back(t);
  }
  return list;
}

double VertexRings::score(const Vec3& a, const Vec3& b, const Vec3& c) {
  return score_of(norm(b - a), norm(c - b), norm(a - c), norm(cross(b - a, c - a)));
}

}  // namespace evenmesh
