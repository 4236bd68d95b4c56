#include "refine/give_way.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <vector>

namespace evenmesh {
namespace {

constexpr double good_enough = 1.08;  ///< conformal energy
constexpr double max_step = 0.3;      ///< of the edge length
constexpr double min_step = 0.003;    ///< of the edge length
constexpr double min_cosine = 0.34;   ///< of a triangle's turn in a step

/// A triangle with its corner p, and by how much its conformal energy is too large.
struct Shape {
  Vec3 normal;  ///< twice the area long
  double twice_area, scale, conformal;

  Shape(const Vec3& p, const Vec3& q, const Vec3& r)
      : normal(cross(q - p, r - p)),
        twice_area(norm(normal)),
        scale(1 / (2 * std::numbers::sqrt3 * twice_area)),
        conformal(scale * (squared_norm(q - p) + squared_norm(r - q) + squared_norm(p - r))) {}
  double excess() const { return std::max(conformal - good_enough, 0.0); }
};

class Relaxation {
 public:
  Relaxation(Mesh& mesh, const VertexRings& rings, const Projector* projector)
      : mesh_(mesh), rings_(rings), projector_(projector) {}

  /// Whether v moved.
  bool step(std::uint32_t v) {
    const double before = energy(v, false);
    if (!(before > 0)) return false;
    double edge = 0;
    const Vec3 step = newton_step(v, edge);
    if (!(norm(step) > min_step * edge)) return false;
    Vec3& position = mesh_.vertices[v];
    const Vec3 original = position;
    rings_.normals(v, normals_);
    for (const double share : {1.0, 0.4, 0.15}) {
      const Vec3 trial = original + share * step;
      position = projector_ ? projector_->project(trial, max_step * edge) : trial;
      if (energy(v, true) < 0.999 * before) return true;
    }
    position = original;
    return false;
  }

 private:
  std::array<Vec3, 3> corners_from(std::uint32_t v, std::uint32_t t) const {
    const Triangle& c = mesh_.triangles[t];
    const int k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
    return {mesh_.vertices[c[k]], mesh_.vertices[c[(k + 1) % 3]], mesh_.vertices[c[(k + 2) % 3]]};
  }
  /// Infinite when `compared` and a triangle has turned too far.
  double energy(std::uint32_t v, bool compared) const {
    double sum = 0;
    const auto around = rings_.triangles(v);
    for (std::size_t i = 0; i < around.size(); ++i) {
      const auto [p, q, r] = corners_from(v, around[i]);
      const Shape shape(p, q, r);
      if (!(shape.twice_area > 0) || (compared && dot(shape.normal, normals_[i]) < min_cosine * shape.twice_area))
        return std::numeric_limits<double>::infinity();
      sum += shape.excess() * shape.excess();
    }
    return sum;
  }
  Vec3 newton_step(std::uint32_t v, double& edge) const {
    const TangentPlane plane(rings_.normal(v));
    double gu = 0, gv = 0, huu = 0, huv = 0, hvv = 0, lengths = 0;
    for (const std::uint32_t t : rings_.triangles(v)) {
      const auto [p, q, r] = corners_from(v, t);
      const Shape shape(p, q, r);
      lengths += norm(q - p);
      const double x = shape.excess();
      if (!(x > 0) || !(shape.twice_area > 0)) continue;
      const Vec3 gradient = 2 * shape.scale * (2 * p - q - r) -
                            (shape.conformal / (shape.twice_area * shape.twice_area)) * cross(shape.normal, r - q);
      const double u = dot(gradient, plane.u), w = dot(gradient, plane.v);
      // The second derivatives of the conformal energy are about those of an equilateral triangle.
      const double curvature = 8 * shape.scale * x;
      gu += x * u;
      gv += x * w;
      huu += u * u + curvature;
      huv += u * w;
      hvv += w * w + curvature;
    }
    edge = lengths / static_cast<double>(rings_.triangles(v).size());
    const double determinant = huu * hvv - huv * huv;
    if (!(determinant > 0)) return {};
    Vec3 step = ((huv * gv - hvv * gu) / determinant) * plane.u + ((huv * gu - huu * gv) / determinant) * plane.v;
    if (const double length = norm(step); length > max_step * edge) step *= max_step * edge / length;
    return step;
  }

  Mesh& mesh_;
  const VertexRings& rings_;
  const Projector* projector_;
  std::vector<Vec3> normals_;
};

}  // namespace

void give_way(Mesh& mesh, const VertexRings& rings, const Projector* projector, std::span<const std::uint32_t> vertices,
              int sweeps) {
  Relaxation relaxation(mesh, rings, projector);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    bool moved = false;
    for (const std::uint32_t v : vertices) moved |= relaxation.step(v);
    if (!moved) break;
  }
}

}  // namespace evenmesh
