#include "topology/regularize.h"

#include <algorithm>
#include <cmath>

#include "geometry/segment.h"

namespace evenmesh {
namespace {

constexpr double first_radius = 0.5, last_radius = 1, growth = 0.05;  ///< of the edge's length
constexpr double balls_per_spacing = 0.5;

}  // namespace

std::vector<std::uint32_t> RegularizationBalls::next_round(std::span<const BadEdge> edges) {
  std::vector<Ball> active;
  for (const std::uint32_t b : active_) active.push_back(balls_[b]);
  const BallIndex index(active, edge_);
  std::vector<char> met(active.size(), 0);
  std::vector<std::uint32_t> changed;
  for (const BadEdge& edge : edges) {
    const double length = norm(edge.to - edge.from);
    bool meets_ball = false;
    index.near(0.5 * (edge.from + edge.to), 0.5 * length, [&](std::uint32_t b) {
      const double distance2 = closest_point_on_segment(active[b].center, edge.from, edge.to).squared_distance;
      if (distance2 >= active[b].radius * active[b].radius) return;
      meets_ball = true;
      met[b] = 1;
    });
    if (meets_ball) continue;
    const double l = length > 0 ? length : edge_;
    double shortest = length;
    for (int a = 0; a < 3; ++a) shortest = std::min(shortest, std::abs(edge.to[a] - edge.from[a]));
    const auto count =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(balls_per_spacing * shortest / spacing_)));
    for (std::size_t i = 0; i < count; ++i) {
      const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
      changed.push_back(static_cast<std::uint32_t>(balls_.size()));
      balls_.push_back({edge.from + t * (edge.to - edge.from), first_radius * l});
      most_.push_back(last_radius * l);
    }
  }
  for (std::size_t a = 0; a < active_.size(); ++a) {
    if (!met[a]) continue;
    const std::uint32_t b = active_[a];
    balls_[b].radius = std::min(most_[b], balls_[b].radius + growth * most_[b]);
    changed.push_back(b);
  }
  std::sort(changed.begin(), changed.end());
  active_.clear();
  for (const std::uint32_t b : changed)
    if (balls_[b].radius < most_[b]) active_.push_back(b);
  return changed;
}

}  // namespace evenmesh
