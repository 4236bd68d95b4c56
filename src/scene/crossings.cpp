#include "scene/crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "evenmesh/error.h"

namespace evenmesh {
namespace {

constexpr double most_work = 1e9;
constexpr std::size_t most_edges = 4'000'000;  // after cutting
constexpr std::uint32_t none = 0xffffffffu;

[[noreturn]] void refuse() {
  throw UnusableInput("has too many edges that cross or lie side by side; split the polygon");
}

bool before(const Point2& a, const Point2& b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

/// Points by number, equal ones once.
class Points {
 public:
  std::uint32_t number(const Point2& p) {
    const Point2 q{p.x + 0.0, p.y + 0.0};  // no negative zeros
    const auto [at, fresh] = numbers_.try_emplace({q.x, q.y}, static_cast<std::uint32_t>(points_.size()));
    if (fresh) points_.push_back(q);
    return at->second;
  }
  const Point2& operator[](std::uint32_t i) const { return points_[i]; }
  std::size_t size() const { return points_.size(); }

 private:
  std::map<std::pair<double, double>, std::uint32_t> numbers_;
  std::vector<Point2> points_;
};

/// From the smaller to the larger end by x, then y.
struct Edge {
  std::uint32_t a = 0, b = 0;
  friend auto operator<=>(const Edge&, const Edge&) = default;
};

std::vector<Edge> edges_of(const std::vector<Contour>& paths, Points& points) {
  std::vector<Edge> edges;
  for (const Contour& path : paths) {
    for (std::size_t i = 0; i < path.size(); ++i) {
      Edge e{points.number(path[i]), points.number(path[(i + 1) % path.size()])};
      if (e.a == e.b) continue;
      if (before(points[e.b], points[e.a])) std::swap(e.a, e.b);
      edges.push_back(e);
    }
  }
  return edges;
}

/// Visits all pairs of edges whose boxes meet, sorted along one axis and tried against those that overlap there.
class Pairs {
 public:
  Pairs(const std::vector<Edge>& edges, const Points& points) {
    for (const Edge& e : edges) {
      const Point2 &a = points[e.a], &b = points[e.b];
      spans_[0].push_back({a.x, b.x});
      spans_[1].push_back({std::min(a.y, b.y), std::max(a.y, b.y)});
    }
    const std::array work{overlaps(spans_[0]), overlaps(spans_[1])};
    axis_ = work[1] < work[0] ? 1 : 0;
    if (work[axis_] > most_work) refuse();
  }

  /// @param visit  of two edges; false ends it
  template <typename Visit>
  void each(const Visit& visit) const {
    const std::vector<Span>&along = spans_[axis_], &across = spans_[1 - axis_];
    std::vector<std::uint32_t> order(along.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](auto i, auto j) { return along[i].lo < along[j].lo || (along[i].lo == along[j].lo && i < j); });
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size() && along[order[j]].lo <= along[order[i]].hi; ++j) {
        const Span &one = across[order[i]], &other = across[order[j]];
        if (one.lo <= other.hi && other.lo <= one.hi && !visit(order[i], order[j])) return;
      }
    }
  }

 private:
  struct Span {
    double lo = 0, hi = 0;
  };

  /// Number of pairs that overlap along an axis.
  static double overlaps(const std::vector<Span>& spans) {
    std::vector<double> starts;
    for (const Span& s : spans) starts.push_back(s.lo);
    std::sort(starts.begin(), starts.end());
    double count = 0;
    for (const Span& s : spans) {
      count += static_cast<double>(std::upper_bound(starts.begin(), starts.end(), s.hi) -
                                   std::lower_bound(starts.begin(), starts.end(), s.lo));
    }
    return count;
  }

  std::array<std::vector<Span>, 2> spans_;
  std::size_t axis_ = 0;
};

/// Whether p, which lies on the line of the edge, is between its ends.
bool inside_of(const Points& points, const Edge& e, std::uint32_t p) {
  return before(points[e.a], points[p]) && before(points[p], points[e.b]);
}

/// How two edges meet elsewhere than at common ends: as points to cut them at.
struct Meeting {
  std::array<std::uint32_t, 2> first{none, none}, second{none, none};  ///< ends of the other one
  bool crossing = false;                                               ///< in the middle of both
  bool any() const {
    return crossing || first[0] != none || first[1] != none || second[0] != none || second[1] != none;
  }
};

Meeting meeting(const Points& points, const Edge& e, const Edge& f) {
  const int ea = orient2d(points[f.a], points[f.b], points[e.a]), eb = orient2d(points[f.a], points[f.b], points[e.b]);
  const int fa = orient2d(points[e.a], points[e.b], points[f.a]), fb = orient2d(points[e.a], points[e.b], points[f.b]);
  Meeting m;
  if (fa == 0 && inside_of(points, e, f.a)) m.first[0] = f.a;
  if (fb == 0 && inside_of(points, e, f.b)) m.first[1] = f.b;
  if (ea == 0 && inside_of(points, f, e.a)) m.second[0] = e.a;
  if (eb == 0 && inside_of(points, f, e.b)) m.second[1] = e.b;
  m.crossing = ea * eb < 0 && fa * fb < 0;
  return m;
}

/// Cuts edges until they meet at their ends only.
class Cutter {
 public:
  Cutter(std::vector<Edge> edges, Points& points) : edges_(std::move(edges)), points_(points) {
    double size = 0;
    for (std::uint32_t i = 0; i < points.size(); ++i)
      size = std::max({size, std::abs(points[i].x), std::abs(points[i].y)});
    step_ = std::ldexp(1.0, std::ilogb(size) - 40);
  }

  std::vector<Edge> run() {
    constexpr int most_rounds = 30;  // rounded crossings move edges by so little that few cross anew
    for (int round = 0; cut(); ++round)
      if (round == most_rounds) throw UnusableInput("crosses itself where it nearly touches; simplify the polygon");
    return std::move(edges_);
  }

 private:
  bool cut() {
    cancel();
    std::vector<std::vector<std::uint32_t>> cuts(edges_.size());
    std::size_t count = 0;
    Pairs(edges_, points_).each([&](std::uint32_t i, std::uint32_t j) {
      const Meeting m = meeting(points_, edges_[i], edges_[j]);
      for (const std::uint32_t p : m.first)
        if (p != none) cuts[i].push_back(p), ++count;
      for (const std::uint32_t p : m.second)
        if (p != none) cuts[j].push_back(p), ++count;
      if (m.crossing) {
        const std::uint32_t p = points_.number(crossing(edges_[i], edges_[j]));
        cuts[i].push_back(p), cuts[j].push_back(p), count += 2;
      }
      if (count > most_edges) refuse();
      return true;
    });
    std::vector<Edge> pieces;
    for (std::size_t i = 0; i < edges_.size(); ++i) split(edges_[i], cuts[i], pieces);
    edges_ = std::move(pieces);
    return count > 0;
  }

  /// An edge that is there an even number of times borders nothing.
  void cancel() {
    std::sort(edges_.begin(), edges_.end());
    std::vector<Edge> kept;
    for (const Edge& e : edges_) {
      if (!kept.empty() && kept.back() == e) {
        kept.pop_back();
      } else {
        kept.push_back(e);
      }
    }
    edges_ = std::move(kept);
  }

  Point2 crossing(const Edge& e, const Edge& f) const {
    const Point2 &a = points_[e.a], &b = points_[e.b], &c = points_[f.a], &d = points_[f.b];
    const double away = (d.x - c.x) * (a.y - c.y) - (d.y - c.y) * (a.x - c.x);
    const double along = (b.x - a.x) * (d.y - c.y) - (b.y - a.y) * (d.x - c.x);
    const double t = along == 0 ? 0.5 : std::clamp(away / along, 0.0, 1.0);
    const auto rounded = [&](double v) { return step_ > 0 ? std::round(v / step_) * step_ : v; };
    return {rounded(a.x + t * (b.x - a.x)), rounded(a.y + t * (b.y - a.y))};
  }

  void split(const Edge& e, std::vector<std::uint32_t>& cuts, std::vector<Edge>& pieces) const {
    const Point2 &a = points_[e.a], &b = points_[e.b];
    const auto along = [&](std::uint32_t p) {
      return (points_[p].x - a.x) * (b.x - a.x) + (points_[p].y - a.y) * (b.y - a.y);
    };
    std::sort(cuts.begin(), cuts.end(), [&](auto p, auto q) {
      const double at_p = along(p), at_q = along(q);
      return at_p < at_q || (at_p == at_q && p < q);
    });
    std::uint32_t from = e.a;
    cuts.push_back(e.b);
    for (const std::uint32_t to : cuts) {
      if (to == from) continue;
      pieces.push_back(before(points_[from], points_[to]) ? Edge{from, to} : Edge{to, from});
      from = to;
    }
  }

  std::vector<Edge> edges_;
  Points& points_;
  double step_ = 0;
};

/// Walks along edges that meet at their ends only, the inside to the left. An even number of them ends in every point,
/// and around it inside and outside alternate.
class Walker {
 public:
  Walker(const std::vector<Edge>& edges, const Points& points) : edges_(edges), points_(points) {
    around_.resize(points.size());
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      around_[edges[i].a].push_back(i);
      around_[edges[i].b].push_back(i);
    }
    for (std::uint32_t v = 0; v < around_.size(); ++v) sort_around(v);
  }

  Outline run() {
    direct();
    Outline outline;
    std::vector<bool> done(edges_.size());
    for (std::uint32_t first = 0; first < edges_.size(); ++first) {
      if (done[first]) continue;
      Contour& contour = outline.contours.emplace_back();
      for (std::uint32_t e = first; !done[e]; e = next(e)) {
        done[e] = true;
        contour.push_back(points_[forward_[e] ? edges_[e].a : edges_[e].b]);
      }
    }
    return outline;
  }

 private:
  std::uint32_t other_end(std::uint32_t e, std::uint32_t v) const {
    return edges_[e].a == v ? edges_[e].b : edges_[e].a;
  }

  /// Counter-clockwise, beginning where edges are "forward" in their order, upwards.
  void sort_around(std::uint32_t v) {
    std::sort(around_[v].begin(), around_[v].end(), [&](std::uint32_t e, std::uint32_t f) {
      const std::uint32_t p = other_end(e, v), q = other_end(f, v);
      const bool e_forward = before(points_[v], points_[p]), f_forward = before(points_[v], points_[q]);
      if (e_forward != f_forward) return e_forward;
      return orient2d(points_[v], points_[p], points_[q]) > 0;
    });
  }

  /// Clockwise from the edge along which a walk arrives, so that it stays around the same piece of inside.
  std::uint32_t next(std::uint32_t e) const {
    const std::uint32_t v = forward_[e] ? edges_[e].b : edges_[e].a;
    const std::vector<std::uint32_t>& ring = around_[v];
    const auto at = static_cast<std::size_t>(std::find(ring.begin(), ring.end(), e) - ring.begin());
    return ring[(at + ring.size() - 1) % ring.size()];
  }

  /// One edge of each piece by counting what lies below it, the others by going around the points.
  void direct() {
    forward_.resize(edges_.size());
    std::vector<bool> known(edges_.size());
    std::vector<std::uint32_t> open;
    double work = 0;
    for (std::uint32_t first = 0; first < edges_.size(); ++first) {
      if (known[first]) continue;
      if ((work += static_cast<double>(edges_.size())) > most_work) refuse();
      forward_[first] = !inside_below(edges_[first]);
      known[first] = true;
      open.push_back(first);
      while (!open.empty()) {
        const std::uint32_t e = open.back();
        open.pop_back();
        for (const std::uint32_t v : {edges_[e].a, edges_[e].b}) spread(e, v, known, open);
      }
    }
  }

  void spread(std::uint32_t from, std::uint32_t v, std::vector<bool>& known, std::vector<std::uint32_t>& open) {
    const std::vector<std::uint32_t>& ring = around_[v];
    const auto at = static_cast<std::size_t>(std::find(ring.begin(), ring.end(), from) - ring.begin());
    bool leaves = forward_[from] == (edges_[from].a == v);
    for (std::size_t i = 1; i < ring.size(); ++i) {
      const std::uint32_t e = ring[(at + i) % ring.size()];
      leaves = !leaves;
      if (known[e]) continue;
      known[e] = true;
      forward_[e] = leaves == (edges_[e].a == v);
      open.push_back(e);
    }
  }

  /// Whether the inside is to the right of an edge, from its smaller to its larger end: an odd number of edges lies
  /// below, just behind its smaller end.
  bool inside_below(const Edge& e) const {
    bool inside = false;
    for (const Edge& f : edges_) {
      if (before(points_[e.a], points_[f.a]) || !before(points_[e.a], points_[f.b])) continue;
      const int side = f.a == e.a ? -orient2d(points_[e.a], points_[f.b], points_[e.b])
                                  : -orient2d(points_[f.a], points_[f.b], points_[e.a]);
      if (side < 0) inside = !inside;
    }
    return inside;
  }

  const std::vector<Edge>& edges_;
  const Points& points_;
  std::vector<std::vector<std::uint32_t>> around_;  ///< edges at a point, counter-clockwise
  std::vector<bool> forward_;                       ///< walked from a to b
};

}  // namespace

bool paths_meet(const std::vector<Contour>& paths) {
  Points points;
  const std::vector<Edge> edges = edges_of(paths, points);
  if (points.size() < edges.size()) return true;  // a point is used twice
  bool meet = false;
  Pairs(edges, points).each([&](std::uint32_t i, std::uint32_t j) {
    meet = meeting(points, edges[i], edges[j]).any();
    return !meet;
  });
  return meet;
}

Outline untangled(const std::vector<Contour>& paths) {
  Points points;
  std::vector<Edge> edges = edges_of(paths, points);
  const std::vector<Edge> cut = Cutter(std::move(edges), points).run();
  return Walker(cut, points).run();
}

}  // namespace evenmesh
