#include "features/polyline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evenmesh {

std::vector<PolylinePoint> thinned(const std::vector<PolylinePoint>& points, double step) {
  std::vector<PolylinePoint> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool last = i + 1 == points.size();
    if (i > 0 && !last &&
        (norm(points[i].place - kept.back().place) < step || norm(points[i].place - points.back().place) < step))
      continue;
    kept.push_back(points[i]);
  }
  return kept;
}

double length_of(const std::vector<PolylinePoint>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += norm(points[i].place - points[i - 1].place);
  return length;
}

Polyline::Polyline(std::vector<PolylinePoint> points, bool closed) : points_(std::move(points)), closed_(closed) {
  up_to_.push_back(0);
  for (std::size_t i = 1; i < points_.size(); ++i)
    up_to_.push_back(up_to_.back() + norm(points_[i].place - points_[i - 1].place));
}

Vec3 Polyline::at(double s) const {
  if (closed_) s -= length() * std::floor(s / length());
  const auto next = std::clamp<std::ptrdiff_t>(std::upper_bound(up_to_.begin(), up_to_.end(), s) - up_to_.begin(), 1,
                                               static_cast<std::ptrdiff_t>(points_.size()) - 1);
  const auto i = static_cast<std::size_t>(next);
  const double step = up_to_[i] - up_to_[i - 1], share = step > 0 ? (s - up_to_[i - 1]) / step : 0;
  return points_[i - 1].place + std::clamp(share, 0.0, 1.0) * (points_[i].place - points_[i - 1].place);
}

double Polyline::turn(std::size_t i, double reach) const {
  const auto clamped = [&](double s) { return closed_ ? s : std::clamp(s, 0.0, length()); };
  const double s = up_to_[i];
  const Vec3 before = points_[i].place - at(clamped(s - reach)), after = at(clamped(s + reach)) - points_[i].place;
  return std::atan2(norm(cross(before, after)), dot(before, after));
}

std::vector<std::size_t> Polyline::turns(double angle, double reach) const {
  const double least = std::cos(angle * std::numbers::pi / 180);
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t i = closed_ ? 1 : 0; i < points_.size(); ++i) {
    const double s = up_to_[i];
    if (!closed_ && (s < reach || s > length() - reach)) continue;
    const double cosine =
        dot(normalized(points_[i].place - at(s - reach)), normalized(at(s + reach) - points_[i].place));
    if (cosine < least) found.push_back({cosine, i});
  }
  std::sort(found.begin(), found.end());
  std::vector<std::size_t> kept;
  for (const auto& [cosine, i] : found) {
    const bool free = std::all_of(kept.begin(), kept.end(), [&, at = i](std::size_t k) {
      const double apart = std::abs(up_to_[at] - up_to_[k]);
      return (closed_ ? std::min(apart, length() - apart) : apart) > 1.5 * reach;
    });
    if (free) kept.push_back(i);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

Vec3 Polyline::corner(std::size_t i, double reach, double most) const {
  const double s = up_to_[i];
  const Vec3 a = at(s - 0.7 * reach), u = normalized(a - at(s - 1.6 * reach));
  const Vec3 b = at(s + 0.7 * reach), v = normalized(b - at(s + 1.6 * reach));
  const Vec3 w = b - a, n = cross(u, v);
  const double n2 = squared_norm(n);
  if (!(n2 > 0.01)) return points_[i].place;
  const Vec3 p = a + (dot(cross(w, v), n) / n2) * u, q = b + (dot(cross(w, u), n) / n2) * v, middle = 0.5 * (p + q);
  return norm(middle - points_[i].place) < most && norm(p - q) < 0.2 * most ? middle : points_[i].place;
}

}  // namespace evenmesh
