#include "geometry/ear_clipping.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace evenmesh {

std::size_t Outline::points() const {
  return std::accumulate(contours.begin(), contours.end(), std::size_t{0},
                         [](std::size_t sum, const Contour& contour) { return sum + contour.size(); });
}

double twice_area(const Contour& contour) {
  double sum = 0;
  if (contour.empty()) return sum;
  const Point2 origin = contour.front();
  for (std::size_t i = 1; i + 1 < contour.size(); ++i) {
    const Point2 &a = contour[i], &b = contour[i + 1];
    sum += (a.x - origin.x) * (b.y - origin.y) - (a.y - origin.y) * (b.x - origin.x);
  }
  return sum;
}

bool encloses(const Contour& contour, const Point2& p) {
  bool inside = false;
  for (std::size_t i = 0, j = contour.size() - 1; i < contour.size(); j = i++) {
    const Point2 &a = contour[j], &b = contour[i];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if ((orient2d(a, b, p) > 0) == (b.y > a.y)) inside = !inside;
  }
  return inside;
}

namespace {

/// Cuts ears off a polygon whose holes were joined to it by bridges (Meisters, Polygons have ears, American
/// Mathematical Monthly 82, 1975). All ears turn left and their borders add up to the polygon's, so that they cannot
/// overlap.
class EarClipper {
 public:
  EarClipper(const Outline& outline, std::size_t steps) : steps_(steps) {
    points_.reserve(outline.points());
    for (const Contour& contour : outline.contours) {
      std::vector<std::uint32_t> ring(contour.size());
      std::iota(ring.begin(), ring.end(), static_cast<std::uint32_t>(points_.size()));
      points_.insert(points_.end(), contour.begin(), contour.end());
      rings_.push_back(std::move(ring));
    }
  }

  /// False where it does not work out.
  bool run(const Outline& outline) {
    std::vector<std::size_t> owner(rings_.size());
    for (std::size_t i = 0; i < rings_.size(); ++i) {
      if (!hole(outline, i)) continue;
      const std::size_t outer = smallest_around(outline, i);
      if (outer == rings_.size()) return false;
      owner[i] = outer;
    }
    for (std::size_t i = 0; i < rings_.size(); ++i) {
      if (hole(outline, i)) continue;
      std::vector<std::size_t> holes;
      for (std::size_t j = 0; j < rings_.size(); ++j)
        if (hole(outline, j) && owner[j] == i) holes.push_back(j);
      if (!join(i, std::move(holes)) || !clip(rings_[i])) return false;
    }
    return true;
  }

  std::vector<Triangle> take() { return std::move(triangles_); }
  std::size_t steps_left() const { return work_ < steps_ ? steps_ - work_ : 0; }

 private:
  using Ring = std::vector<std::uint32_t>;

  static bool hole(const Outline& outline, std::size_t i) { return twice_area(outline.contours[i]) < 0; }

  static std::size_t smallest_around(const Outline& outline, std::size_t i) {
    std::size_t found = outline.contours.size();
    for (std::size_t j = 0; j < outline.contours.size(); ++j) {
      if (hole(outline, j) || !encloses(outline.contours[j], outline.contours[i].front())) continue;
      if (found == outline.contours.size() || twice_area(outline.contours[j]) < twice_area(outline.contours[found]))
        found = j;
    }
    return found;
  }

  bool spend(std::size_t steps) {
    work_ += steps;
    return work_ < steps_;
  }

  /// Holes from the right to the left, each with what is in the ring already.
  bool join(std::size_t outer, std::vector<std::size_t> holes) {
    const auto rightmost = [&](std::size_t h) {
      return std::max_element(rings_[h].begin(), rings_[h].end(),
                              [&](auto a, auto b) { return points_[a].x < points_[b].x; });
    };
    std::stable_sort(holes.begin(), holes.end(),
                     [&](auto a, auto b) { return points_[*rightmost(a)].x > points_[*rightmost(b)].x; });
    for (std::size_t h = 0; h < holes.size(); ++h) {
      Ring& ring = rings_[holes[h]];
      std::rotate(ring.begin(), rightmost(holes[h]), ring.end());
      const std::size_t at = visible_from(rings_[outer], holes, h);
      if (at == rings_[outer].size()) return false;
      Ring bridge = ring;
      bridge.push_back(ring.front());
      bridge.push_back(rings_[outer][at]);
      rings_[outer].insert(rings_[outer].begin() + static_cast<std::ptrdiff_t>(at) + 1, bridge.begin(), bridge.end());
    }
    return true;
  }

  /// The nearest place of the ring that the hole's first point sees; its size if there is none.
  std::size_t visible_from(const Ring& ring, const std::vector<std::size_t>& holes, std::size_t h) {
    const std::uint32_t from = rings_[holes[h]].front();
    std::vector<std::size_t> order(ring.size());
    std::iota(order.begin(), order.end(), 0);
    const auto distance = [&](std::size_t i) {
      return std::hypot(points_[ring[i]].x - points_[from].x, points_[ring[i]].y - points_[from].y);
    };
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return distance(a) < distance(b); });
    for (const std::size_t i : order) {
      const std::size_t n = ring.size();
      if (!in_corner(ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n], from)) continue;
      bool clear = !crosses(ring, from, ring[i]);
      for (std::size_t k = h; clear && k < holes.size(); ++k) clear = !crosses(rings_[holes[k]], from, ring[i]);
      if (work_ >= steps_) return n;
      if (clear) return i;
    }
    return ring.size();
  }

  int side(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return orient2d(points_[a], points_[b], points_[c]);
  }

  /// Whether p lies in the corner b between the edges a b and b c, the shape being on the left.
  bool in_corner(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t p) const {
    if (side(a, b, c) > 0) return side(a, b, p) > 0 && side(b, c, p) > 0;
    return side(a, b, p) > 0 || side(b, c, p) > 0;
  }

  /// Whether an edge of the ring touches the segment, except at its ends.
  bool crosses(const Ring& ring, std::uint32_t from, std::uint32_t to) {
    spend(ring.size());
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::uint32_t a = ring[i], b = ring[(i + 1) % ring.size()];
      if (a == from || b == from || a == to || b == to) continue;
      if (side(a, b, from) * side(a, b, to) <= 0 && side(from, to, a) * side(from, to, b) <= 0) return true;
    }
    return false;
  }

  bool clip(const Ring& ring) {
    const std::size_t n = ring.size();
    std::vector<std::size_t> next(n), previous(n);
    for (std::size_t i = 0; i < n; ++i) {
      next[i] = (i + 1) % n;
      previous[i] = (i + n - 1) % n;
    }
    std::size_t left = n, at = 0, tried = 0;
    bool flat_too = false;  // corners of 180° only when nothing else is left
    while (left > 2) {
      if (!spend(1)) return false;
      const std::size_t a = previous[at], c = next[at];
      const int turn = side(ring[a], ring[at], ring[c]);
      if ((turn > 0 && empty_ear(ring, next, a, at, c)) || (turn == 0 && flat_too)) {
        triangles_.push_back({ring[a], ring[at], ring[c]});
        next[a] = c;
        previous[c] = a;
        --left;
        tried = 0;
        flat_too = false;
        at = c;
        continue;
      }
      at = c;
      if (++tried < left) continue;
      if (flat_too) return false;
      flat_too = true;
      tried = 0;
    }
    return true;
  }

  /// No other corner lies in the triangle or on its border.
  bool empty_ear(const Ring& ring, const std::vector<std::size_t>& next, std::size_t a, std::size_t b, std::size_t c) {
    const Point2 &pa = points_[ring[a]], &pb = points_[ring[b]], &pc = points_[ring[c]];
    const double lo_x = std::min({pa.x, pb.x, pc.x}), hi_x = std::max({pa.x, pb.x, pc.x});
    const double lo_y = std::min({pa.y, pb.y, pc.y}), hi_y = std::max({pa.y, pb.y, pc.y});
    std::size_t steps = 0;
    for (std::size_t i = next[c]; i != a; i = next[i]) {
      ++steps;
      const Point2& p = points_[ring[i]];
      if (p.x < lo_x || p.x > hi_x || p.y < lo_y || p.y > hi_y) continue;
      if (same_place(p, pa) || same_place(p, pb) || same_place(p, pc)) continue;
      if (orient2d(pa, pb, p) >= 0 && orient2d(pb, pc, p) >= 0 && orient2d(pc, pa, p) >= 0) {
        spend(steps);
        return false;
      }
    }
    spend(steps);
    return true;
  }

  Contour points_;
  std::vector<Ring> rings_;
  std::vector<Triangle> triangles_;
  std::size_t steps_ = 0, work_ = 0;
};

}  // namespace

std::optional<std::vector<Triangle>> ear_clipped(const Outline& outline, std::size_t& steps) {
  EarClipper clipper(outline, steps);
  const bool done = clipper.run(outline);
  steps = clipper.steps_left();
  if (!done) return {};
  return clipper.take();
}

}  // namespace evenmesh
