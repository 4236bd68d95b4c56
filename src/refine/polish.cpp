#include "refine/polish.h"

#include <array>
#include <cmath>
#include <numbers>

namespace evenmesh {
namespace {

double triangle_quality(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double x = norm(b - a), y = norm(c - b), z = norm(a - c);
  const double longest = std::max({x, y, z}), half = 0.5 * (x + y + z);
  return half > 0 ? 3 * norm(cross(b - a, c - a)) / (std::numbers::sqrt3 * half * longest) : 0;
}

class Polisher {
 public:
  Polisher(Mesh& mesh, const Projector* projector, double wanted) : mesh_(mesh), projector_(projector), wanted_(wanted) {
    start_.assign(mesh.vertices.size() + 1, 0);
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) ++start_[v + 1];
    for (std::size_t v = 0; v + 1 < start_.size(); ++v) start_[v + 1] += start_[v];
    around_.resize(3 * mesh.triangles.size());
    std::vector<std::uint32_t> fill(start_.begin(), start_.end() - 1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t v : mesh.triangles[t]) around_[fill[v]++] = static_cast<std::uint32_t>(t);
  }

  std::vector<std::uint32_t> vertices_of_bad_triangles() const {
    std::vector<char> bad(mesh_.vertices.size(), 0);
    for (const Triangle& t : mesh_.triangles)
      if (quality(t) < wanted_)
        for (const std::uint32_t v : t) bad[v] = 1;
    std::vector<std::uint32_t> list;
    for (std::uint32_t v = 0; v < bad.size(); ++v)
      if (bad[v]) list.push_back(v);
    return list;
  }

  bool improve(std::uint32_t v) {
    Vec3& position = mesh_.vertices[v];
    const Vec3 original = position;
    Vec3 normal;
    double edge = 0;
    for (std::uint32_t at = start_[v]; at < start_[v + 1]; ++at) {
      const Triangle& t = mesh_.triangles[around_[at]];
      const Vec3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
      normal += cross(b - a, c - a);
      edge += norm(b - a) + norm(c - b) + norm(a - c);
    }
    edge /= 3.0 * (start_[v + 1] - start_[v]);
    normal = normalized(normal);
    const Vec3 u = normalized(cross(normal, std::abs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})), w = cross(normal, u);
    const double before = worst_around(v, normal);
    double best = before;
    for (const double step : {0.2, 0.1, 0.05, 0.02, 0.01}) {
      if (best >= wanted_) break;
      Vec3 best_position = position;
      const Vec3 from = position;
      for (int direction = 0; direction < 8; ++direction) {
        const double angle = direction * std::numbers::pi / 4;
        position = on_surface(from + (edge * step * std::cos(angle)) * u + (edge * step * std::sin(angle)) * w, edge);
        const double worst = worst_around(v, normal);
        if (worst > best + 1e-6) best = worst, best_position = position;
      }
      position = best_position;
    }
    if (best > before + 1e-6) return true;
    position = original;
    return false;
  }

 private:
  double quality(const Triangle& t) const {
    return triangle_quality(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
  }
  Vec3 on_surface(const Vec3& p, double edge) const { return projector_ ? projector_->project(p, 0.3 * edge) : p; }

  /// Smallest Q around a vertex; negative where a triangle turns away from `normal`.
  double worst_around(std::uint32_t v, const Vec3& normal) const {
    double worst = 2;
    for (std::uint32_t at = start_[v]; at < start_[v + 1]; ++at) {
      const Triangle& t = mesh_.triangles[around_[at]];
      const Vec3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
      double q = triangle_quality(a, b, c);
      if (dot(normalized(cross(b - a, c - a)), normal) < 0.2) q -= 1;
      worst = std::min(worst, q);
    }
    return worst;
  }

  Mesh& mesh_;
  const Projector* projector_;
  double wanted_;
  std::vector<std::uint32_t> start_, around_;
};

}  // namespace

std::size_t polish(Mesh& mesh, const Projector* projector, const PolishOptions& options, Run& run) {
  Polisher polisher(mesh, projector, options.quality);
  std::vector<char> ever(mesh.vertices.size(), 0);
  for (int round = 0; round < options.rounds; ++round) {
    run.throw_if_cancelled();
    std::size_t moved = 0;
    for (const std::uint32_t v : polisher.vertices_of_bad_triangles())
      if (polisher.improve(v)) ++moved, ever[v] = 1;
    if (moved == 0) break;
  }
  std::size_t count = 0;
  for (const char e : ever) count += e;
  return count;
}

}  // namespace evenmesh
