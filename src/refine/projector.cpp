#include "refine/projector.h"

#include <algorithm>
#include <array>

#include "geometry/closest_point.h"
#include "shape/field.h"

namespace evenmesh {
namespace {

/// Closest point of the mesh within the bounds, or of the bounds' faces where they cut the mesh.
class MeshProjector : public Projector {
 public:
  MeshProjector(const Mesh& mesh, const Box& bounds, Run& run) : query_(mesh, run), bounds_(bounds) {
    const Box own = mesh.bounds();
    for (int a = 0; a < 3; ++a) cut_[2 * a] = own.lo[a]<bounds.lo[a], cut_[2 * a + 1] = own.hi[a]> bounds.hi[a];
  }
  Vec3 project(const Vec3& p, double limit) const override {
    Vec3 best = p;
    double nearest = limit * limit;
    if (const ClosestPoint closest = query_.closest(p, limit); closest.found()) {
      best = inside_cuts(closest.point);
      nearest = squared_norm(best - p);
    }
    for (int face = 0; face < 6; ++face) {
      if (!cut_[face]) continue;
      Vec3 q = inside_cuts(p);
      q[face / 2] = face % 2 == 0 ? bounds_.lo[face / 2] : bounds_.hi[face / 2];
      if (const double distance = squared_norm(q - p); distance < nearest) nearest = distance, best = q;
    }
    return best;
  }

 private:
  Vec3 inside_cuts(Vec3 p) const {
    for (int a = 0; a < 3; ++a) {
      if (cut_[2 * a]) p[a] = std::max(p[a], bounds_.lo[a]);
      if (cut_[2 * a + 1]) p[a] = std::min(p[a], bounds_.hi[a]);
    }
    return p;
  }

  SurfaceQuery query_;
  Box bounds_;
  std::array<bool, 6> cut_{};  ///< faces of the bounds that the mesh crosses: x lower, x upper, y lower, …
};

/// Newton's iteration for max(f, distance to the bounds) = 0, along the gradient.
class FieldProjector : public Projector {
 public:
  FieldProjector(std::shared_ptr<const Field> field, const Box& bounds) : field_(std::move(field)), bounds_(bounds) {}
  Vec3 project(const Vec3& p, double limit) const override {
    Vec3 q = p;
    for (int step = 0; step < 8; ++step) {
      const Vec3 move = newton_step(q);
      if (!is_finite(move)) return p;
      const double length = norm(move);
      q += length > 0.5 * limit ? move * (0.5 * limit / length) : move;
      if (squared_norm(q - p) > limit * limit) return p;
      if (length < 1e-9 * limit) break;
    }
    return q;
  }

 private:
  Vec3 newton_step(const Vec3& p) const {
    Vec3 gradient;
    const double value = field_->evaluate(p, &gradient);
    const double slope2 = squared_norm(gradient);
    const Vec3 field_step = slope2 > 0 ? gradient * (-value / slope2) : Vec3{};
    const double field_distance = slope2 > 0 ? value / std::sqrt(slope2) : 0;
    // Signed distance to the nearest face of the bounds, positive outside.
    double face_distance = -std::numeric_limits<double>::infinity();
    Vec3 face_step;
    for (int a = 0; a < 3; ++a) {
      const double below = bounds_.lo[a] - p[a], above = p[a] - bounds_.hi[a];
      if (below > face_distance) face_distance = below, face_step = {}, face_step[a] = below;
      if (above > face_distance) face_distance = above, face_step = {}, face_step[a] = -above;
    }
    return face_distance > field_distance ? face_step : field_step;
  }

  std::shared_ptr<const Field> field_;
  Box bounds_;
};

}  // namespace

std::unique_ptr<Projector> make_projector(const Shape& shape, const Box& bounds, Run& run) {
  if (const Mesh* mesh = shape.mesh()) return std::make_unique<MeshProjector>(*mesh, bounds, run);
  if (!shape.field() || !shape.field()->has_gradient()) return nullptr;
  return std::make_unique<FieldProjector>(std::get<std::shared_ptr<const Field>>(shape.what), bounds);
}

}  // namespace evenmesh
