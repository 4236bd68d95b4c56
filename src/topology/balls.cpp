#include "topology/balls.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "grid/morton.h"
#include "grid/solid_editor.h"

namespace evenmesh {
namespace {

class Union {
 public:
  Union(const SampleSet& samples, std::span<const Ball> balls, ExecutionContext& context)
      : samples_(samples), editor_(samples), balls_(balls), context_(context) {}

  SampleSet result() {
    std::vector<Vec3> centers;
    std::vector<double> radii;
    for (const Ball& ball : balls_) {
      centers.push_back(ball.center);
      radii.push_back(ball.radius);
    }
    touched_ = editor_.bricks_near(centers, radii);
    if (!samples_.even()) find_relative_weights();
    std::vector<NewBlock> made(touched_.size());
    parallel_for(context_, touched_.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) made[t] = remake(morton_decode(touched_[t].first), touched_[t].second);
    });
    return editor_.replace(made, context_);
  }

 private:
  /// Of what a ball adds: weight over area of the samples in the bricks that it touches.
  void find_relative_weights() {
    std::vector<double> area(balls_.size(), 0), weight(balls_.size(), 0);
    for (const auto& [key, balls] : touched_) {
      const SolidEditor::Sums here = editor_.sums_of(morton_decode(key));
      for (const std::uint32_t b : balls) {
        area[b] += here.area;
        weight[b] += here.weight;
      }
    }
    relative_weight_.resize(balls_.size());
    for (std::size_t b = 0; b < balls_.size(); ++b)
      relative_weight_[b] = area[b] > 0 ? weight[b] / area[b] : samples_.total_weight / samples_.total_area;
  }

  NewBlock remake(const SolidEditor::Brick& brick, const std::vector<std::uint32_t>& balls) const {
    const BrickSigns before = editor_.signs(brick);
    BrickSigns after = before;
    for (int k = 0; k < BrickSigns::side; ++k)
      for (int j = 0; j < BrickSigns::side; ++j)
        for (int i = 0; i < BrickSigns::side; ++i) {
          if (editor_.on_border(brick, i, j, k)) continue;
          const Vec3 p = editor_.point(brick, i, j, k);
          for (const std::uint32_t b : balls)
            if (squared_norm(p - balls_[b].center) < balls_[b].radius * balls_[b].radius) after.inside(i, j, k) = true;
        }
    return editor_.remake(brick, before, after, [&](const CrossedEdge& edge) { return place(edge, brick, balls); });
  }

  /// The old place, unless it lies in a ball.
  std::optional<NewCrossing> place(const CrossedEdge& edge, const SolidEditor::Brick& brick,
                                   const std::vector<std::uint32_t>& balls) const {
    const double h = samples_.grid.spacing;
    Vec3 step;
    step[edge.axis] = edge.lower_inside ? h : -h;
    Vec3 from = editor_.point(brick, edge.at[0], edge.at[1], edge.at[2]);  // the inner end
    if (!edge.lower_inside) from[edge.axis] += h;
    NewCrossing made;
    if (edge.old != BrickSigns::none) {
      const Vec3 p =
          editor_.point(brick, 4, 4, 4) + Vec3{samples_.x[edge.old], samples_.y[edge.old], samples_.z[edge.old]};
      made.t = std::clamp((p[edge.axis] - from[edge.axis]) / step[edge.axis], 0.0, 1.0);
      made.normal = unpack_normal(samples_.normal[edge.old]);
    }
    bool moved = false;
    std::uint32_t ball = balls.front();
    for (int attempt = 0; attempt < 4; ++attempt) {  // out of one ball, perhaps into the next
      double farthest = made.t;
      for (const std::uint32_t b : balls) {
        const Vec3 p = from + made.t * step - balls_[b].center;
        const double inside = balls_[b].radius * balls_[b].radius - squared_norm(p);
        if (inside <= 0) continue;
        const double along = dot(p, step) / (h * h);
        const double exit = made.t - along + std::sqrt(along * along + inside / (h * h));
        if (exit <= farthest) continue;
        farthest = exit;
        made.normal = normalized(from + exit * step - balls_[b].center);
        ball = b;
      }
      if (farthest <= made.t) break;
      made.t = farthest;
      moved = true;
    }
    if (edge.old != BrickSigns::none && !moved) return {};
    if (made.t >= 1 || !moved) {  // the border cuts the ball
      made.t = std::min(made.t, 0.999);
      made.normal = step / h;
    }
    if (!samples_.even()) made.relative_weight = relative_weight_[ball];
    return made;
  }

  const SampleSet& samples_;
  SolidEditor editor_;
  std::span<const Ball> balls_;
  ExecutionContext& context_;
  std::vector<std::pair<std::uint64_t, std::vector<std::uint32_t>>> touched_;
  std::vector<double> relative_weight_;  ///< by ball; unused where the samples are even
};

}  // namespace

SampleSet unite_balls(const SampleSet& samples, std::span<const Ball> balls, ExecutionContext& context) {
  return Union(samples, balls, context).result();
}

BallIndex::BallIndex(std::vector<Ball> balls, double largest_radius)
    : largest_(std::accumulate(balls.begin(), balls.end(), largest_radius,
                               [](double largest, const Ball& b) { return std::max(largest, b.radius); })),
      centers_(largest_) {
  for (const Ball& b : balls) add(b);
}

void BallIndex::add(const Ball& ball) {
  centers_.add(ball.center);
  balls_.push_back(ball);
}

Vec3 BallIndex::outside(Vec3 p) const {
  for (int attempt = 0; attempt < 8; ++attempt) {
    double deepest = 0;
    Vec3 out;
    near(p, 0, [&](std::uint32_t b) {
      const Vec3 d = p - balls_[b].center;
      const double length = norm(d), depth = balls_[b].radius - length;
      if (depth > deepest && length > 0) {
        deepest = depth;
        out = balls_[b].center + d * (balls_[b].radius / length);
      }
    });
    if (deepest <= 1e-9 * largest_) return p;
    p = out;
  }
  return p;
}

}  // namespace evenmesh
