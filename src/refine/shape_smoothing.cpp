#include "refine/shape_smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/lbfgs.h"
#include "refine/vertex_rings.h"

namespace evenmesh {
namespace {

constexpr double max_step = 0.2;          ///< of the edge length, for a vertex in one step
constexpr double projection_limit = 0.5;  ///< of the edge length
constexpr std::size_t steps_per_projection = 10;
constexpr int max_attempts = 6;     ///< at a step
constexpr double plane_weight = 4;  ///< λ: RMS distances stay within a few percent of what they were
constexpr std::size_t grain = 2048;

/// Coordinates of a vertex in its tangent plane, model units.
struct Tangential {
  double u = 0, v = 0;

  Tangential& operator+=(const Tangential& o) {
    u += o.u;
    v += o.v;
    return *this;
  }
  Tangential& operator-=(const Tangential& o) {
    u -= o.u;
    v -= o.v;
    return *this;
  }
  Tangential& operator*=(double s) {
    u *= s;
    v *= s;
    return *this;
  }
  friend Tangential operator*(double s, Tangential t) { return t *= s; }
  friend Tangential operator-(Tangential a, const Tangential& b) { return a -= b; }
  friend double dot(const Tangential& a, const Tangential& b) { return a.u * b.u + a.v * b.v; }
};

using Coordinates = std::vector<Tangential>;

/// Where a vertex may go: base + u·frame.u + v·frame.v. On a curve v is the zero vector; where it stays, both are.
struct Frame {
  Vec3 u, v;
};

/// Gradient of a triangle's energy in its first two corners; that in the third is minus their sum.
struct TriangleGradient {
  Vec3 a, b;
};

/// Energy of one triangle. @param target  twice the area it should have
double triangle_energy(const Vec3& a, const Vec3& b, const Vec3& c, double target, double size_weight,
                       const Vec3& facing, TriangleGradient& gradient) {
  constexpr double least_cosine = 0.5;
  const Vec3 ab = b - a, bc = c - b, ca = a - c, normal = cross(ab, bc);
  const double twice_area = norm(normal);
  if (!(dot(normal, facing) > least_cosine * twice_area)) return std::numeric_limits<double>::infinity();
  const double per_area = 1 / twice_area;
  const double scale = per_area / (2 * std::numbers::sqrt3);
  const double conformal = scale * (squared_norm(ab) + squared_norm(bc) + squared_norm(ca));
  const double size = std::log(twice_area / target);
  const Vec3 unit = per_area * normal;
  const double by_area = (size_weight * size - conformal) * per_area;
  gradient.a = 2 * scale * (ca - ab) + by_area * cross(unit, bc);
  gradient.b = 2 * scale * (ab - bc) + by_area * cross(unit, ca);
  return conformal - 1 + 0.5 * size_weight * size * size;
}

class Smoothing {
 public:
  Smoothing(Mesh& mesh, const Projector* projector, const SizingField& sizing, const ShapeSmoothingOptions& options,
            ExecutionContext& context, const VertexConstraints& constraints)
      : mesh_(mesh),
        projector_(projector),
        sizing_(sizing),
        options_(options),
        context_(context),
        constraints_(constraints),
        rings_(mesh, context),
        stays_(mesh.vertices.size()),
        base_(mesh.vertices),
        frames_(mesh.vertices.size()),
        at_(mesh.vertices.size()),
        trial_(at_),
        gradient_(at_),
        trial_gradient_(at_),
        edge_(mesh.vertices.size()),
        inverse_diagonal_(mesh.vertices.size()),
        facing_(mesh.triangles.size()),
        target_(mesh.triangles.size()),
        energy_of_(mesh.triangles.size()),
        gradient_of_(mesh.triangles.size()),
        plane_energy_(mesh.vertices.size()) {}

  ShapeSmoothingResult run() {
    const std::vector<Vec3> start = mesh_.vertices;
    each_vertex([&](std::uint32_t v) { stays_[v] = must_stay(v); });
    make_frames();
    result_.energy_before = mean(energy_);
    std::size_t steps = 0;
    while (result_.evaluations < options_.evaluations) {
      const bool stepped = step();
      if (!stepped && history_.empty()) break;
      if (!stepped)
        history_.clear();
      else if (++steps % steps_per_projection == 0) {
        move_onto_surface();
        make_frames();
      }
    }
    if (steps % steps_per_projection != 0) move_onto_surface();
    undo_harm(start);
    result_.energy = mean(energy_);
    return result_;
  }

 private:
  double mean(double energy) const { return energy / static_cast<double>(mesh_.triangles.size()); }
  bool stays(std::uint32_t v) const { return stays_[v] != 0; }
  bool must_stay(std::uint32_t v) const {
    if (rings_.triangles(v).empty() || rings_.on_boundary(v) || constraints_.at_corner(v)) return true;
    // Where a curve turns as much as its chords may, they must not become longer.
    constexpr double tight = 0.5;
    return constraints_.vertex(v) &&
           constraints_.chordal_deviation(mesh_, v, rings_.neighbours(v)) > tight * constraints_.max_chordal_deviation;
  }
  template <typename Op>
  void each_vertex(const Op& op) const {
    parallel_for(context_, base_.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) op(static_cast<std::uint32_t>(v));
    });
  }
  template <typename Op>
  void each_triangle(const Op& op) const {
    parallel_for(context_, mesh_.triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) op(t);
    });
  }

  void place(const Coordinates& at) {
    each_vertex(
        [&](std::uint32_t v) { mesh_.vertices[v] = base_[v] + at[v].u * frames_[v].u + at[v].v * frames_[v].v; });
  }
  void move_onto_surface() {
    place(at_);
    each_vertex([&](std::uint32_t v) {
      Vec3& p = mesh_.vertices[v];
      if (!stays(v))
        p = constraints_.vertex(v) ? constraints_.slide(v, p)
            : projector_           ? projector_->project(p, projection_limit * edge_[v])
                                   : p;
      base_[v] = p;
      at_[v] = {};
    });
  }

  /// Where what was bad has become worse, as beside curves that do not give way, vertices go back.
  void undo_harm(const std::vector<Vec3>& start) {
    constexpr double bad = 0.7;  // score: Q 0.49, angles of 25°
    constexpr int rounds = 8;
    for (int round = 0; round < rounds; ++round) {
      bool undone = false;
      for (const std::uint32_t t : triangles_below(mesh_, bad, context_)) {
        const auto [a, b, c] = mesh_.triangles[t];
        if (rings_.score(mesh_.triangles[t]) >= VertexRings::score(start[a], start[b], start[c]) - 1e-6) continue;
        for (const std::uint32_t v : {a, b, c}) mesh_.vertices[v] = start[v];
        undone = true;
      }
      if (!undone) return;
    }
  }

  /// Tangent planes where vertices are now. Coordinates turn as little as they can, so that what is known of the energy
  /// still holds.
  void make_frames() {
    each_vertex([&](std::uint32_t v) { frames_[v] = stays(v) ? Frame{} : frame_of(v); });
    find_targets();
    each_vertex([&](std::uint32_t v) {
      edge_[v] = rings_.triangles(v).empty() ? 0 : rings_.edge_length(v);
      // Second derivatives of an equilateral triangle's energy in one corner are 4 (1 + μ) / 3l² across the far side.
      const double curvature =
          static_cast<double>(rings_.triangles(v).size()) * (1 + 0.5 * options_.size_weight) * 4 / 3;
      inverse_diagonal_[v] = curvature > 0 ? edge_[v] * edge_[v] / curvature : 0;
    });
    energy_ = evaluate(at_, gradient_);
  }
  Frame frame_of(std::uint32_t v) const {
    if (constraints_.vertex(v)) return {curve_direction(v), {}};
    const Vec3 normal = rings_.normal(v), before = frames_[v].u - dot(frames_[v].u, normal) * normal;
    if (squared_norm(before) < 0.25) {
      const TangentPlane plane(normal);
      return {plane.u, plane.v};
    }
    const Vec3 u = normalized(before);
    return {u, cross(normal, u)};
  }
  /// Zero where no two edges along a curve meet.
  Vec3 curve_direction(std::uint32_t v) const {
    std::vector<Vec3> ends;
    for (const std::uint32_t w : rings_.neighbours(v))
      if (constraints_.edge(v, w)) ends.push_back(mesh_.vertices[w]);
    return ends.size() == 2 ? normalized(ends[1] - ends[0]) : Vec3{};
  }
  void find_targets() {
    each_triangle([&](std::size_t t) {
      const auto& [a, b, c] = corners(t);
      const Vec3 normal = cross(b - a, c - a);
      const double twice_area = norm(normal);
      facing_[t] = twice_area > 0 ? (1 / twice_area) * normal : Vec3{};
      energy_of_[t] = twice_area;
      gradient_of_[t] = {};
      const double edge = sizing_.uniform() ? 1 : sizing_.edge((1.0 / 3) * (a + b + c));
      target_[t] = edge * edge;
    });
    const auto sum = [&](const std::vector<double>& of) {
      return ordered_sum(context_, of.size(), [&](std::size_t t) { return of[t]; });
    };
    const double scale = sum(energy_of_) / sum(target_);
    each_triangle([&](std::size_t t) {
      target_[t] *= scale;
      energy_of_[t] = 0;
    });
  }
  std::array<Vec3, 3> corners(std::size_t t) const {
    const Triangle& c = mesh_.triangles[t];
    return {mesh_.vertices[c[0]], mesh_.vertices[c[1]], mesh_.vertices[c[2]]};
  }

  double evaluate(const Coordinates& at, Coordinates& gradient) {
    context_.throw_if_cancelled();
    ++result_.evaluations;
    place(at);
    each_triangle([&](std::size_t t) {
      const auto& [a, b, c] = corners(t);
      if (facing_[t] == Vec3{}) return;  // without area since frames were made
      energy_of_[t] = triangle_energy(a, b, c, target_[t], options_.size_weight, facing_[t], gradient_of_[t]);
    });
    each_vertex([&](std::uint32_t v) {
      Vec3 sum;
      for (const std::uint32_t t : rings_.triangles(v)) {
        const Triangle& c = mesh_.triangles[t];
        const TriangleGradient& g = gradient_of_[t];
        sum += c[0] == v ? g.a : c[1] == v ? g.b : -1.0 * (g.a + g.b);
      }
      sum += plane_gradient(v);
      gradient[v] = {dot(sum, frames_[v].u), dot(sum, frames_[v].v)};
    });
    return ordered_sum(context_, energy_of_.size(), [&](std::size_t t) { return energy_of_[t]; }) +
           ordered_sum(context_, plane_energy_.size(), [&](std::size_t v) { return plane_energy_[v]; });
  }

  /// And the energy itself, but for a constant.
  Vec3 plane_gradient(std::uint32_t v) {
    if (v >= options_.planes.size() || !(edge_[v] > 0) || !(options_.planes[v].quadric.weight() > 0)) return {};
    const auto& [origin, quadric] = options_.planes[v];
    const double scale = plane_weight / (quadric.weight() * edge_[v] * edge_[v]);
    const Vec3 x = mesh_.vertices[v] - origin;
    plane_energy_[v] = scale * quadric.excess(x);
    return 2 * scale * quadric.half_gradient(x);
  }

  /// Whether a step downhill was found and taken.
  bool step() {
    Coordinates direction = history_.direction(gradient_, inverse_diagonal_);
    each_vertex([&](std::uint32_t v) {
      const double length = std::sqrt(dot(direction[v], direction[v]));
      if (length > max_step * edge_[v]) direction[v] *= max_step * edge_[v] / length;
    });
    double factor = 1;
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
      const double slope = algebra_.dot_all(direction, gradient_);
      if (!(slope < 0)) return false;
      each_vertex([&](std::uint32_t v) {
        trial_[v] = at_[v];
        trial_[v] += factor * direction[v];
      });
      const double energy = evaluate(trial_, trial_gradient_);
      if (energy <= energy_ + 1e-4 * factor * slope) {
        take(energy);
        return true;
      }
      if (energy < std::numeric_limits<double>::infinity())
        factor *= 0.4;
      else
        leave_turning(direction);
    }
    return false;
  }
  /// Vertices of triangles that would turn too far sit this step out.
  void leave_turning(Coordinates& direction) const {
    for (std::size_t t = 0; t < energy_of_.size(); ++t)
      if (energy_of_[t] == std::numeric_limits<double>::infinity())
        for (const std::uint32_t v : mesh_.triangles[t]) direction[v] = {};
  }
  void take(double energy) {
    Coordinates moved(at_.size()), change(at_.size());
    each_vertex([&](std::uint32_t v) {
      moved[v] = trial_[v] - at_[v];
      change[v] = trial_gradient_[v] - gradient_[v];
    });
    history_.add(std::move(moved), std::move(change));
    at_.swap(trial_);
    gradient_.swap(trial_gradient_);
    energy_ = energy;
  }

  Mesh& mesh_;
  const Projector* projector_;
  const SizingField& sizing_;
  const ShapeSmoothingOptions& options_;
  ExecutionContext& context_;
  const VertexConstraints& constraints_;
  const VertexRings rings_;
  const VariableAlgebra<Tangential> algebra_{context_};
  LimitedMemoryHessian<Tangential> history_{algebra_};
  ShapeSmoothingResult result_;
  double energy_ = 0;
  std::vector<char> stays_;
  std::vector<Vec3> base_;  ///< by vertex: the origin of its tangential coordinates
  std::vector<Frame> frames_;
  Coordinates at_, trial_, gradient_, trial_gradient_;
  std::vector<double> edge_, inverse_diagonal_;
  std::vector<Vec3> facing_;    ///< by triangle: its normal when frames were made
  std::vector<double> target_;  ///< by triangle: twice the area wanted
  std::vector<double> energy_of_;
  std::vector<TriangleGradient> gradient_of_;
  std::vector<double> plane_energy_;
};

}  // namespace

double size_weight_of(double evenness) {
  return 0.02 * std::pow(25.0, evenness);
}

ShapeSmoothingResult smooth_shapes(Mesh& mesh, const Projector* projector, const SizingField& sizing,
                                   const ShapeSmoothingOptions& options, ExecutionContext& context,
                                   const VertexConstraints& constraints) {
  if (mesh.triangles.empty() || options.evaluations == 0) return {};
  return Smoothing(mesh, projector, sizing, options, context, constraints).run();
}

}  // namespace evenmesh
