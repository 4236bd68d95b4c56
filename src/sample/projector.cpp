#include "sample/projector.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/closest_point.h"
#include "grid/morton.h"
#include "shape/field.h"

namespace evenmesh {
namespace {

/// Closest point of the mesh within the bounds, or of the bounds' faces where they cut the mesh.
class MeshProjector : public Projector {
 public:
  MeshProjector(const Mesh& mesh, const Box& bounds, ExecutionContext& context)
      : query_(mesh, context), bounds_(bounds) {
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

class SampleProjector : public Projector {
 public:
  explicit SampleProjector(const SampleSet& samples) : samples_(samples) {
    for (std::uint32_t b = 0; b < samples.blocks.size(); ++b) {
      const auto& at = samples.blocks[b].brick;
      codes_.push_back({morton_code(at[0], at[1], at[2]), b});
    }
  }
  Vec3 project(const Vec3& p, double limit) const override {
    Nearest nearest;
    nearest.squared_distance = limit * limit;
    search(p, nearest);
    if (!nearest.found) return p;
    const Vec3 q = p - dot(p - nearest.position, nearest.normal) * nearest.normal;
    return squared_norm(q - p) <= limit * limit ? q : p;
  }

 private:
  struct Nearest {
    double squared_distance = 0;
    bool found = false;
    Vec3 position, normal;
  };

  /// The brick that holds p first, then those around it that may hold a nearer sample.
  void search(const Vec3& p, Nearest& nearest) const {
    const Vec3 at = (p - samples_.grid.origin) / (samples_.grid.spacing * brick_size);
    std::array<int, 3> home{};
    for (int a = 0; a < 3; ++a) home[std::size_t(a)] = static_cast<int>(std::floor(at[a]));
    search_brick(p, home, nearest);
    for (int reach = 1;; ++reach) {
      // A sample in the ring lies at least so far away; edges reach one cell beyond their brick.
      const double least = (reach - 1 - 1.0 / brick_size) * brick_size * samples_.grid.spacing;
      if (least > 0 && least * least >= nearest.squared_distance) return;
      if (reach > 64) return;
      for (int k = -reach; k <= reach; ++k)
        for (int j = -reach; j <= reach; ++j)
          for (int i = -reach; i <= reach; i += std::max(std::abs(j), std::abs(k)) == reach ? 1 : 2 * reach)
            search_brick(p, {home[0] + i, home[1] + j, home[2] + k}, nearest);
    }
  }
  void search_brick(const Vec3& p, const std::array<int, 3>& brick, Nearest& nearest) const {
    if (brick[0] < 0 || brick[1] < 0 || brick[2] < 0) return;
    // Nothing of the brick may be nearer than what is known.
    double away = 0;
    for (int a = 0; a < 3; ++a) {
      const double lo = samples_.grid.origin[a] + samples_.grid.spacing * brick_size * brick[std::size_t(a)];
      const double hi = lo + samples_.grid.spacing * (brick_size + 1), d = std::max({0.0, lo - p[a], p[a] - hi});
      away += d * d;
    }
    if (away >= nearest.squared_distance) return;
    const std::uint64_t code = morton_code(std::uint64_t(brick[0]), std::uint64_t(brick[1]), std::uint64_t(brick[2]));
    const auto found = std::lower_bound(codes_.begin(), codes_.end(), std::pair(code, std::uint32_t{0}));
    if (found == codes_.end() || found->first != code) return;
    const SampleBlock& block = samples_.blocks[found->second];
    const Vec3 center = samples_.block_center(block), local = p - center;
    for (std::uint32_t s = block.begin; s < block.end; ++s) {
      const Vec3 x{samples_.x[s], samples_.y[s], samples_.z[s]};
      const double d = squared_norm(x - local);
      if (d >= nearest.squared_distance) continue;
      nearest = {d, true, center + x, unpack_normal(samples_.normal[s])};
    }
  }

  const SampleSet& samples_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> codes_;  ///< of the blocks' bricks, ascending
};

/// Points and what a field says of them.
struct Evaluated {
  explicit Evaluated(std::size_t n) : x(n), y(n), z(n), f(n), dx(n), dy(n), dz(n) {}
  void place(std::size_t i, const Vec3& p) {
    x[i] = static_cast<float>(p.x), y[i] = static_cast<float>(p.y), z[i] = static_cast<float>(p.z);
  }
  PointBatch batch() const { return {x, y, z}; }
  std::vector<float> x, y, z, f, dx, dy, dz;
};

}  // namespace

void step_onto(std::span<Vec3> points, const Field& field, const Box& bounds, double limit) {
  const std::size_t n = points.size();
  Evaluated here(n), there(n);
  std::vector<Vec3> target(n);
  for (int step = 0; step < 2; ++step) {
    for (std::size_t i = 0; i < n; ++i) here.place(i, points[i]);
    field.evaluate_gradient(here.batch(), here.f, here.dx, here.dy, here.dz);
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 gradient{here.dx[i], here.dy[i], here.dz[i]};
      const Vec3 move = gradient * (-here.f[i] / squared_norm(gradient)), to = points[i] + move;
      bool well = is_finite(move) && squared_norm(move) <= limit * limit;
      for (int a = 0; a < 3; ++a) well = well && to[a] - bounds.lo[a] > limit && bounds.hi[a] - to[a] > limit;
      target[i] = well ? to : points[i];
      there.place(i, target[i]);
    }
    field.evaluate(there.batch(), there.f);
    for (std::size_t i = 0; i < n; ++i)
      if (std::abs(there.f[i]) <= 0.5f * std::abs(here.f[i])) points[i] = target[i];
  }
}

std::unique_ptr<Projector> make_projector(const SampleSet& samples) {
  return std::make_unique<SampleProjector>(samples);
}

std::unique_ptr<Projector> make_projector(const Shape& shape, const Box& bounds, ExecutionContext& context) {
  if (const Mesh* mesh = shape.mesh()) return std::make_unique<MeshProjector>(*mesh, bounds, context);
  if (!shape.field() || !shape.field()->has_gradient()) return nullptr;
  return std::make_unique<FieldProjector>(std::get<std::shared_ptr<const Field>>(shape.what), bounds);
}

}  // namespace evenmesh
