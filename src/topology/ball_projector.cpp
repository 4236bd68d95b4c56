#include "topology/ball_projector.h"

#include <algorithm>

namespace evenmesh {
namespace {

class BallProjector final : public Projector {
 public:
  BallProjector(std::unique_ptr<Projector> inner, const BallIndex& balls) : inner_(std::move(inner)), balls_(balls) {}

  Vec3 project(const Vec3& p, double limit) const override {
    const Vec3 q = inner_ ? inner_->project(p, limit) : p, out = balls_.outside(q);
    if (out == q) return q;
    // The shape's own surface is covered here: the spheres count.
    const Vec3 on_sphere = onto_sphere(p, limit);
    return squared_norm(on_sphere - p) <= limit * limit ? on_sphere : p;
  }

 private:
  /// From outside the nearest sphere within the limit, from inside the way out.
  Vec3 onto_sphere(const Vec3& p, double limit) const {
    double nearest = limit;
    Vec3 best = p;
    balls_.near(p, limit, [&](std::uint32_t b) {
      const Ball& ball = balls_.balls()[b];
      const Vec3 d = p - ball.center;
      const double length = norm(d), distance = length - ball.radius;
      if (!(length > 0 && distance > 0 && distance < nearest)) return;
      nearest = distance;
      best = ball.center + d * (ball.radius / length);
    });
    return balls_.outside(best);
  }

  std::unique_ptr<Projector> inner_;
  const BallIndex& balls_;
};

class FillingProjector final : public Projector {
 public:
  FillingProjector(std::unique_ptr<Projector> inner, const PointHash& filled, double spacing, bool everywhere)
      : inner_(std::move(inner)), filled_(filled), spacing_(spacing), everywhere_(everywhere) {}

  Vec3 project(const Vec3& p, double limit) const override {
    if (!inner_) return p;
    const bool is_near = everywhere_ || filled_.near(p, 3 * spacing_, [](std::uint32_t) { return true; });
    return inner_->project(p, is_near ? std::min(limit, spacing_) : limit);
  }

 private:
  std::unique_ptr<Projector> inner_;
  const PointHash& filled_;
  double spacing_;
  bool everywhere_;
};

}  // namespace

std::unique_ptr<Projector> make_filling_projector(std::unique_ptr<Projector> inner, const PointHash& filled,
                                                  double spacing, bool everywhere) {
  return std::make_unique<FillingProjector>(std::move(inner), filled, spacing, everywhere);
}

std::unique_ptr<Projector> make_ball_projector(std::unique_ptr<Projector> inner, const BallIndex& balls) {
  return std::make_unique<BallProjector>(std::move(inner), balls);
}

}  // namespace evenmesh
