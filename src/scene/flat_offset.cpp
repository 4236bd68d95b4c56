#include "scene/flat_offset.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "scene/crossings.h"

namespace evenmesh {
namespace {

Point2 moved(const Point2& p, const Point2& direction, double distance) {
  return {p.x + distance * direction.x, p.y + distance * direction.y};
}

/// The side of the shape's border, to the right of an edge.
Point2 outward(const Point2& a, const Point2& b) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  return {(b.y - a.y) / length, -(b.x - a.x) / length};
}

/// Between the strips of two edges that meet in p, with outward normals m and n.
Contour join_at(const Point2& p, const Point2& m, const Point2& n, double distance, const FlatOffset& how) {
  constexpr double sharpest = 1e-6;  // miters end somewhere
  const double turn = std::atan2(m.x * n.y - m.y * n.x, m.x * n.x + m.y * n.y);
  Contour join{p, moved(p, m, distance)};
  if (how.join == FlatJoin::round) {
    const auto pieces = std::ceil(turn / (2 * std::numbers::pi) * static_cast<double>(how.fragments));
    for (double i = 1; i < pieces; ++i) {
      const double angle = turn * i / pieces, c = std::cos(angle), s = std::sin(angle);
      join.push_back(moved(p, {c * m.x - s * m.y, s * m.x + c * m.y}, distance));
    }
  } else if (how.join == FlatJoin::miter && std::cos(turn / 2) > sharpest) {
    const double scale = distance / (1 + m.x * n.x + m.y * n.y);
    join.push_back(moved(p, {m.x + n.x, m.y + n.y}, scale));
  } else {  // cut off at right angles to the bisector, as far away as the strips reach
    const double along = std::tan(turn / 4);
    join.push_back(moved(p, {m.x - along * m.y, m.y + along * m.x}, distance));
    join.push_back(moved(p, {n.x + along * n.y, n.y - along * n.x}, distance));
  }
  join.push_back(moved(p, n, distance));
  return join;
}

/// Strips and joins, counter-clockwise.
void add_border(const Contour& contour, double distance, const FlatOffset& how, std::vector<Outline>& pieces) {
  const std::size_t n = contour.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 &a = contour[i], &b = contour[(i + 1) % n], &c = contour[(i + 2) % n];
    const Point2 m = outward(a, b);
    pieces.push_back({{{a, moved(a, m, distance), moved(b, m, distance), b}}});
    if (orient2d(a, b, c) > 0) pieces.push_back({{join_at(b, m, outward(b, c), distance, how)}});
  }
}

}  // namespace

Outline offset_outline(const Outline& outline, const FlatOffset& how) {
  if (outline.contours.empty() || how.distance == 0) return outline;
  std::vector<Outline> pieces{outline};
  for (Contour contour : outline.contours) {
    if (how.distance < 0) std::reverse(contour.begin(), contour.end());
    add_border(contour, std::abs(how.distance), how, pieces);
  }
  return combined(how.distance > 0 ? FlatSet::unite : FlatSet::subtract, pieces);
}

}  // namespace evenmesh
