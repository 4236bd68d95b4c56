#include "geometry/point_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/parallel.h"

namespace evenmesh {
namespace {

constexpr std::size_t leaf_size = 8;

double power_of_two_against(const std::vector<Vec3>& points) {
  double largest = 0;
  for (const Vec3& p : points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return largest > 0 ? std::scalbn(1.0, -std::clamp(std::ilogb(largest), -1000, 1000)) : 1.0;
}

int longest_axis(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& p : points) box.add(p);
  const Vec3 size = box.size();
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

std::size_t middle(std::size_t begin, std::size_t end) {
  return begin + (end - begin) / 2;
}

}  // namespace

/// The nearest squared distances so far.
struct PointTree::Search {
  Vec3 p;
  std::span<double> squared;

  void offer(double d) {
    if (!(d > 0 && d < squared.back())) return;
    std::size_t i = squared.size() - 1;
    for (; i > 0 && squared[i - 1] > d; --i) squared[i] = squared[i - 1];
    squared[i] = d;
  }
};

PointTree::PointTree(const std::vector<Vec3>& points, const ExecutionContext& context)
    : scale_(power_of_two_against(points)), points_(points.size()) {
  parallel_for(context, points.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points_[i] = points[i] * scale_;
  });
  std::sort(points_.begin(), points_.end(),
            [](const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
  points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
  build(context);
}

/// Level by level, the nodes of a level in parallel.
void PointTree::build(const ExecutionContext& context) {
  std::vector<std::size_t> ends{0, points_.size()};  // of the ranges of a level's nodes
  splits_.resize(1);
  while (points_.size() > leaf_size * (ends.size() - 1)) {
    const std::size_t nodes = ends.size() - 1;
    std::vector<std::size_t> next(2 * nodes + 1);
    splits_.resize(2 * nodes);
    parallel_tasks(context, nodes, [&](std::size_t i) {
      const std::size_t begin = ends[i], end = ends[i + 1], mid = middle(begin, end);
      const auto at = [&](std::size_t k) { return points_.begin() + static_cast<std::ptrdiff_t>(k); };
      const int axis = longest_axis({points_.data() + begin, end - begin});
      std::nth_element(at(begin), at(mid), at(end), [&](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
      splits_[nodes + i] = {points_[mid][axis], static_cast<std::uint8_t>(axis)};
      next[2 * i] = begin;
      next[2 * i + 1] = mid;
    });
    next.back() = points_.size();
    ends.swap(next);
  }
}

void PointTree::nearest(const Vec3& p, std::span<double> distances) const {
  if (distances.empty()) return;
  std::fill(distances.begin(), distances.end(), std::numeric_limits<double>::infinity());
  Search found{p * scale_, distances};
  search(1, 0, points_.size(), {}, 0, found);
  for (double& d : distances) d = std::sqrt(d) / scale_;
}

/// @param gap      how far p is from the node's cell, along each axis
/// @param squared  its squared length
void PointTree::search(std::size_t node, std::size_t begin, std::size_t end, Vec3 gap, double squared,
                       Search& found) const {
  if (node >= splits_.size()) {
    for (std::size_t i = begin; i < end; ++i) found.offer(squared_norm(points_[i] - found.p));
    return;
  }
  const Split& split = splits_[node];
  const std::size_t mid = middle(begin, end);
  const double beyond = found.p[split.axis] - split.at;
  const bool upper = beyond >= 0;
  search(2 * node + upper, upper ? mid : begin, upper ? end : mid, gap, squared, found);
  const double far = squared + (beyond * beyond - gap[split.axis] * gap[split.axis]);
  if (far >= found.squared.back()) return;
  gap[split.axis] = beyond;
  search(2 * node + !upper, upper ? begin : mid, upper ? mid : end, gap, far, found);
}

}  // namespace evenmesh
