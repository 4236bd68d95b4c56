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

constexpr double max_work = 3e8;
constexpr std::size_t max_edges = 4'000'000;  // after cutting
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
  std::int64_t rise = 1;  ///< of the winding number from its right (below) to its left (above)
};

void add_edges(const std::vector<Contour>& paths, std::int64_t weight, Points& points, std::vector<Edge>& edges) {
  for (const Contour& path : paths) {
    for (std::size_t i = 0; i < path.size(); ++i) {
      Edge e{points.number(path[i]), points.number(path[(i + 1) % path.size()]), weight};
      if (e.a == e.b) continue;
      if (before(points[e.b], points[e.a])) e = {e.b, e.a, -weight};
      edges.push_back(e);
    }
  }
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
    if (work[axis_] > max_work) refuse();
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
    constexpr int max_rounds = 30;  // rounded crossings move edges by so little that few cross anew
    for (int round = 0; cut(); ++round)
      if (round == max_rounds) throw UnusableInput("crosses itself where it nearly touches; simplify the polygon");
    return std::move(edges_);
  }

 private:
  bool cut() {
    merge();
    std::vector<std::vector<std::uint32_t>> cuts(edges_.size());
    std::size_t count = 0;
    const auto cut_at = [&](std::uint32_t edge, std::uint32_t p) {
      if (p == none) return;
      cuts[edge].push_back(p);
      ++count;
    };
    Pairs(edges_, points_).each([&](std::uint32_t i, std::uint32_t j) {
      const Meeting m = meeting(points_, edges_[i], edges_[j]);
      for (const std::uint32_t p : m.first) cut_at(i, p);
      for (const std::uint32_t p : m.second) cut_at(j, p);
      if (m.crossing) {
        const std::uint32_t p = points_.number(crossing(edges_[i], edges_[j]));
        cut_at(i, p);
        cut_at(j, p);
      }
      if (count > max_edges) refuse();
      return true;
    });
    std::vector<Edge> pieces;
    for (std::size_t i = 0; i < edges_.size(); ++i) split(edges_[i], cuts[i], pieces);
    edges_ = std::move(pieces);
    return count > 0;
  }

  /// One edge where several are the same, none where they cancel.
  void merge() {
    std::sort(edges_.begin(), edges_.end(),
              [](const Edge& e, const Edge& f) { return e.a < f.a || (e.a == f.a && e.b < f.b); });
    std::vector<Edge> kept;
    for (const Edge& e : edges_) {
      if (!kept.empty() && kept.back().a == e.a && kept.back().b == e.b) {
        kept.back().rise += e.rise;
      } else {
        kept.push_back(e);
      }
    }
    std::erase_if(kept, [](const Edge& e) { return e.rise == 0; });
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
      pieces.push_back(before(points_[from], points_[to]) ? Edge{from, to, e.rise} : Edge{to, from, -e.rise});
      from = to;
    }
  }

  std::vector<Edge> edges_;
  Points& points_;
  double step_ = 0;
};

/// Walks along the border of a region among edges that meet at their ends only, the region to the left.
/// @tparam Inside  whether a winding number belongs to the region
template <typename Inside>
class Walker {
 public:
  Walker(const std::vector<Edge>& edges, const Points& points, Inside inside)
      : edges_(edges), points_(points), inside_(inside) {
    around_.resize(points.size());
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      around_[edges[i].a].push_back(i);
      around_[edges[i].b].push_back(i);
    }
    for (std::uint32_t v = 0; v < around_.size(); ++v) sort_around(v);
  }

  Outline run() {
    wind();
    Outline outline;
    std::vector<bool> done(edges_.size());
    for (std::uint32_t first = 0; first < edges_.size(); ++first) {
      if (done[first] || !border(first)) continue;
      Contour contour;
      for (std::uint32_t e = first; !done[e]; e = next(e)) {
        done[e] = true;
        contour.push_back(points_[forward(e) ? edges_[e].a : edges_[e].b]);
      }
      contour = without_straight_points(contour);
      if (contour.size() >= 3) outline.contours.push_back(std::move(contour));
    }
    return outline;
  }

 private:
  std::int64_t above(std::uint32_t e) const { return below_[e] + edges_[e].rise; }
  bool border(std::uint32_t e) const { return inside_(below_[e]) != inside_(above(e)); }
  bool forward(std::uint32_t e) const { return inside_(above(e)); }  ///< a border is walked from a to b

  std::uint32_t other_end(std::uint32_t e, std::uint32_t v) const {
    return edges_[e].a == v ? edges_[e].b : edges_[e].a;
  }

  /// Counter-clockwise, those first that begin at v.
  void sort_around(std::uint32_t v) {
    std::sort(around_[v].begin(), around_[v].end(), [&](std::uint32_t e, std::uint32_t f) {
      if ((edges_[e].a == v) != (edges_[f].a == v)) return edges_[e].a == v;
      return orient2d(points_[v], points_[other_end(e, v)], points_[other_end(f, v)]) > 0;
    });
  }

  static std::size_t place(const std::vector<std::uint32_t>& ring, std::uint32_t e) {
    return static_cast<std::size_t>(std::find(ring.begin(), ring.end(), e) - ring.begin());
  }

  /// The next border clockwise from the one along which a walk arrives, so that it stays around one piece of region.
  std::uint32_t next(std::uint32_t e) const {
    const std::vector<std::uint32_t>& ring = around_[forward(e) ? edges_[e].b : edges_[e].a];
    std::size_t at = place(ring, e);
    do {
      at = (at + ring.size() - 1) % ring.size();
    } while (!border(ring[at]));
    return ring[at];
  }

  /// Winding numbers below all edges: of one edge of each piece by summing up what lies below it, of the others by
  /// going around the points.
  void wind() {
    below_.resize(edges_.size());
    std::vector<bool> known(edges_.size());
    std::vector<std::uint32_t> open;
    double work = 0;
    for (std::uint32_t first = 0; first < edges_.size(); ++first) {
      if (known[first]) continue;
      if ((work += static_cast<double>(edges_.size())) > max_work) refuse();
      below_[first] = winding_below(edges_[first]);
      known[first] = true;
      open.push_back(first);
      while (!open.empty()) {
        const std::uint32_t e = open.back();
        open.pop_back();
        for (const std::uint32_t v : {edges_[e].a, edges_[e].b}) spread(e, v, known, open);
      }
    }
  }

  /// Counter-clockwise around v, beginning behind an edge whose numbers are known.
  void spread(std::uint32_t from, std::uint32_t v, std::vector<bool>& known, std::vector<std::uint32_t>& open) {
    const std::vector<std::uint32_t>& ring = around_[v];
    const std::size_t at = place(ring, from);
    std::int64_t winding = edges_[from].a == v ? above(from) : below_[from];
    for (std::size_t i = 1; i < ring.size(); ++i) {
      const std::uint32_t e = ring[(at + i) % ring.size()];
      const bool begins = edges_[e].a == v;
      const std::int64_t below = begins ? winding : winding - edges_[e].rise;
      winding = begins ? winding + edges_[e].rise : below;
      if (known[e]) continue;
      known[e] = true;
      below_[e] = below;
      open.push_back(e);
    }
  }

  /// Below an edge, just behind its smaller end.
  std::int64_t winding_below(const Edge& e) const {
    std::int64_t winding = 0;
    for (const Edge& f : edges_) {
      if (before(points_[e.a], points_[f.a]) || !before(points_[e.a], points_[f.b])) continue;
      const int side = f.a == e.a ? orient2d(points_[e.a], points_[f.b], points_[e.b])
                                  : orient2d(points_[f.a], points_[f.b], points_[e.a]);
      if (side > 0) winding += f.rise;
    }
    return winding;
  }

  static Contour without_straight_points(const Contour& contour) {
    Contour kept;
    for (std::size_t i = 0, n = contour.size(); i < n; ++i) {
      if (orient2d(contour[(i + n - 1) % n], contour[i], contour[(i + 1) % n]) != 0) kept.push_back(contour[i]);
    }
    return kept;
  }

  const std::vector<Edge>& edges_;
  const Points& points_;
  Inside inside_;
  std::vector<std::vector<std::uint32_t>> around_;  ///< edges at a point, counter-clockwise
  std::vector<std::int64_t> below_;                 ///< winding numbers
};

template <typename Inside>
Outline region(std::vector<Edge> edges, Points& points, const Inside& inside) {
  const std::vector<Edge> cut = Cutter(std::move(edges), points).run();
  return Walker(cut, points, inside).run();
}

}  // namespace

bool paths_meet(const std::vector<Contour>& paths) {
  Points points;
  std::vector<Edge> edges;
  add_edges(paths, 1, points, edges);
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
  std::vector<Edge> edges;
  add_edges(paths, 1, points, edges);
  return region(std::move(edges), points, [](std::int64_t winding) { return winding % 2 != 0; });
}

Outline combined(FlatSet set, const std::vector<Outline>& outlines) {
  const auto count = static_cast<std::int64_t>(outlines.size());
  Points points;
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const bool whole = set == FlatSet::subtract && i == 0;  // outweighs all others, so that they can be told apart
    add_edges(outlines[i].contours, whole ? count : 1, points, edges);
  }
  return region(std::move(edges), points,
                [&](std::int64_t winding) { return set == FlatSet::unite ? winding > 0 : winding == count; });
}

}  // namespace evenmesh
