#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "features/apexes.h"
#include "features/crowding.h"
#include "features/edge_graph.h"
#include "features/feature_curves.h"
#include "features/feature_seeds.h"
#include "geometry/union_find.h"

namespace evenmesh {
namespace {

using Index = std::uint32_t;
constexpr Index none = FeatureCurve::none;
constexpr double min_length = 3;  ///< of connected chains together, in edges, and five times that for every loose end
constexpr double loop_length = 1.5;        ///< of a loop from a corner to itself, in edges
constexpr double spur_length = 0.7;        ///< of a branch that ends nowhere, in edges
constexpr double corner_distance = 0.2;    ///< corners nearer than this, in edges, are one
constexpr double crowded_distance = 0.33;  ///< of chains side by side, in edges
constexpr double weak_angle = 0.65;        ///< of the angle asked for: down to this creases go on that fade
constexpr double max_tightened = 1.5;      ///< how much denser vertices are there than elsewhere, at most
constexpr double sharp_turn = 40;          ///< degrees within a few grid cells: a corner

/// A path of nodes between two junctions, or a closed one.
struct Path {
  Index from = none, to = none;  ///< junctions: nodes with one, three or more links
  std::vector<Index> nodes;      ///< those between them; all of a closed path
  double length = 0;             ///< model units
  bool alive = true;
};

struct Point {
  Vec3 place;
  double relative_sizing;
};

/// Points without those that are nearer than `step` to the one before, or to the last one; first and last stay.
std::vector<Point> thinned(const std::vector<Point>& points, double step) {
  std::vector<Point> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool last = i + 1 == points.size();
    if (i > 0 && !last &&
        (norm(points[i].place - kept.back().place) < step || norm(points[i].place - points.back().place) < step))
      continue;
    kept.push_back(points[i]);
  }
  return kept;
}

double length_of(const std::vector<Point>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += norm(points[i].place - points[i - 1].place);
  return length;
}

/// The graph's paths between junctions, cleaned: no noise, no junctions next to each other.
class Network {
 public:
  Network(const FeatureGraph& graph, double edge, double spacing)
      : graph_(graph), edge_(edge), spacing_(spacing), joined_(graph.nodes.size()), planes_(graph.nodes.size()) {
    for (Index v = 0; v < planes_.size(); ++v) planes_[v] = graph.nodes[v].planes;
    list_links();
    trace();
  }

  void clean() {
    for (bool changed = true; changed;) {
      changed = prune();
      changed |= contract();
      changed |= join_at_passings();
    }
    drop_small_parts();
  }

  const std::vector<Path>& paths() const { return paths_; }
  Index junction(Index node) { return node == none ? none : joined_.find(node); }

  /// Where a junction is: where the planes of all its cubes meet.
  Vec3 place(Index root) {
    if (degree(root) < 3) return graph_.nodes[root].place;
    Box box;
    for (Index v : members_[root]) box.add(graph_.nodes[v].place);
    box.add(graph_.nodes[root].place);
    Vec3 p = planes_[root].minimum(2, 3) + origin_;
    for (int a = 0; a < 3; ++a) p[a] = std::clamp(p[a], box.lo[a] - 2 * spacing_, box.hi[a] + 2 * spacing_);
    return p;
  }
  void set_origin(const Vec3& origin) { origin_ = origin; }

  std::vector<Point> points_between(const Path& path) const {
    std::vector<Point> points;
    for (const Index v : path.nodes) points.push_back({graph_.nodes[v].place, graph_.nodes[v].relative_sizing});
    return points;
  }
  double relative_sizing(Index node) const { return graph_.nodes[node].relative_sizing; }

 private:
  struct Link {
    Index other, id;
  };

  /// The sharp links, and the weak ones that continue them.
  void list_links() {
    links_.resize(graph_.nodes.size());
    std::vector<std::vector<Link>> weak(graph_.nodes.size());
    for (Index i = 0; i < graph_.links.size(); ++i) {
      const auto [a, b] = graph_.links[i];
      auto& list = graph_.sharp[i] ? links_ : weak;
      list[a].push_back({b, i}), list[b].push_back({a, i});
    }
    std::vector<Index> ends;
    for (Index v = 0; v < links_.size(); ++v)
      if (links_[v].size() == 1) ends.push_back(v);
    for (const Index v : ends) extend(v, weak);
  }

  /// From a loose end on as long as there is one way to go.
  void extend(Index v, const std::vector<std::vector<Link>>& weak) {
    while (links_[v].size() == 1) {
      std::vector<Link> ways = weak[v];
      std::erase_if(ways, [&](const Link& way) { return way.id == links_[v][0].id; });
      if (ways.size() != 1) return;
      const Index next = ways[0].other;
      links_[v].push_back(ways[0]), links_[next].push_back({v, ways[0].id});
      v = next;
    }
  }

  void trace() {
    std::vector<char> used(graph_.links.size(), 0);
    for (const bool closed : {false, true})
      for (Index v = 0; v < links_.size(); ++v)
        if (closed || links_[v].size() != 2)
          for (const Link& link : links_[v])
            if (!used[link.id]) add_path(follow(v, link, used));
  }

  /// From node v along a link to the next junction, or once around.
  Path follow(Index v, Link link, std::vector<char>& used) const {
    Path path;
    path.from = v;
    used[link.id] = 1;
    while (link.other != v && links_[link.other].size() == 2) {
      path.nodes.push_back(link.other);
      const auto& next = links_[link.other];
      link = next[0].id == link.id ? next[1] : next[0];
      used[link.id] = 1;
    }
    path.to = link.other;
    if (links_[v].size() == 2) path.nodes.push_back(v), path.from = path.to = none;
    return path;
  }

  void add_path(Path path) {
    measure(path);
    paths_.push_back(std::move(path));
  }
  void measure(Path& path) const {
    std::vector<Point> points = points_between(path);
    if (path.from != none) {
      points.insert(points.begin(), {graph_.nodes[path.from].place, 1});
      points.push_back({graph_.nodes[path.to].place, 1});
    } else if (!points.empty()) {
      points.push_back(points.front());
    }
    path.length = length_of(thinned(points, 1.5 * spacing_));
  }

  /// Ends of living paths at every junction.
  std::vector<Index> degrees() {
    std::vector<Index> count(joined_.size(), 0);
    for (const Path& path : paths_)
      if (path.alive && path.from != none) ++count[junction(path.from)], ++count[junction(path.to)];
    return count;
  }
  Index degree(Index root) {
    if (degrees_.empty()) degrees_ = degrees();
    return degrees_[root];
  }

  /// Branches that end nowhere, and loops too small to be seen.
  bool prune() {
    const std::vector<Index> count = degrees();
    bool changed = false;
    for (Path& path : paths_) {
      if (!path.alive || path.from == none) continue;
      const Index a = junction(path.from), b = junction(path.to);
      const bool spur = (count[a] == 1) != (count[b] == 1) && path.length < spur_length * edge_;
      const bool loop = a == b && path.length < loop_length * edge_;
      if (spur || loop) path.alive = false, changed = true;
    }
    return changed;
  }

  /// Junctions that are nearer to each other than corners may be become one.
  bool contract() {
    const double limit = std::max(2 * spacing_, corner_distance * edge_);
    const std::vector<Index> count = degrees();
    std::vector<std::pair<double, Index>> order;
    for (Index p = 0; p < paths_.size(); ++p)
      if (paths_[p].alive && paths_[p].from != none && paths_[p].length < limit) order.push_back({paths_[p].length, p});
    std::sort(order.begin(), order.end());
    bool changed = false;
    for (const auto& [length, p] : order) {
      Path& path = paths_[p];
      const Index a = junction(path.from), b = junction(path.to);
      if (a == b || count[a] < 2 || count[b] < 2) continue;
      joined_.unite(a, b);
      const Index root = junction(a), other = root == a ? b : a;
      merge_into(root, other);
      for (const Index v : path.nodes) planes_[root].add(graph_.nodes[v].planes), members_[root].push_back(v);
      path.alive = false, changed = true;
    }
    return changed;
  }
  void merge_into(Index root, Index other) {
    planes_[root].add(planes_[other]);
    auto& from = members_[other];
    members_[root].push_back(other);
    members_[root].insert(members_[root].end(), from.begin(), from.end());
    members_.erase(other);
  }

  /// Where two paths meet and no third, they are one.
  bool join_at_passings() {
    const std::vector<Index> count = degrees();
    std::vector<std::vector<Index>> at(joined_.size());
    for (Index p = 0; p < paths_.size(); ++p)
      if (paths_[p].alive && paths_[p].from != none)
        for (const Index end : {junction(paths_[p].from), junction(paths_[p].to)})
          if (count[end] == 2) at[end].push_back(p);
    UnionFind now(paths_.size());
    bool changed = false;
    for (Index v = 0; v < at.size(); ++v) {
      if (at[v].size() != 2) continue;
      join(v, now.find(at[v][0]), now.find(at[v][1]), now);
      changed = true;
    }
    return changed;
  }
  void join(Index v, Index p, Index q, UnionFind& now) {
    Path& first = paths_[std::min(p, q)];
    if (p == q) {
      first.nodes.push_back(v);
      first.from = first.to = none;
      return measure(first);
    }
    Path& second = paths_[std::max(p, q)];
    if (junction(first.to) != v) turn_round(first);
    if (junction(second.from) != v) turn_round(second);
    first.nodes.push_back(v);
    first.nodes.insert(first.nodes.end(), second.nodes.begin(), second.nodes.end());
    first.to = second.to;
    second.alive = false;
    now.unite(p, q);
    measure(first);
  }
  static void turn_round(Path& path) {
    std::reverse(path.nodes.begin(), path.nodes.end());
    std::swap(path.from, path.to);
  }

  void drop_small_parts() {
    UnionFind part(joined_.size());
    std::vector<double> length(joined_.size(), 0);
    for (const Path& path : paths_)
      if (path.alive && path.from != none) part.unite(junction(path.from), junction(path.to));
    for (const Path& path : paths_)
      if (path.alive && path.from != none) length[part.find(junction(path.from))] += path.length;
    std::vector<Index> loose_ends(joined_.size(), 0);
    const std::vector<Index> count = degrees();
    for (Index v = 0; v < count.size(); ++v)
      if (count[v] == 1) ++loose_ends[part.find(v)];
    for (Path& path : paths_) {
      const Index root = path.from == none ? none : part.find(junction(path.from));
      const double most = root == none ? path.length : length[root], ends = root == none ? 0 : loose_ends[root];
      if (most < min_length * (1 + 5 * ends) * edge_) path.alive = false;
    }
    degrees_.clear();
  }

  const FeatureGraph& graph_;
  double edge_, spacing_;
  Vec3 origin_;
  std::vector<std::vector<Link>> links_;
  std::vector<Path> paths_;
  UnionFind joined_;                             ///< nodes that are one junction
  std::vector<Quadric> planes_;                  ///< by junction
  std::map<Index, std::vector<Index>> members_;  ///< by junction: the other nodes that are part of it
  std::vector<Index> degrees_;
};

/// A chain as points with lengths, open or closed.
class Polyline {
 public:
  explicit Polyline(std::vector<Point> points, bool closed) : points_(std::move(points)), closed_(closed) {
    up_to_.push_back(0);
    for (std::size_t i = 1; i < points_.size(); ++i)
      up_to_.push_back(up_to_.back() + norm(points_[i].place - points_[i - 1].place));
  }
  double length() const { return up_to_.back(); }
  Vec3 at(double s) const {
    if (closed_) s -= length() * std::floor(s / length());
    const auto next = std::clamp<std::ptrdiff_t>(std::upper_bound(up_to_.begin(), up_to_.end(), s) - up_to_.begin(), 1,
                                                 static_cast<std::ptrdiff_t>(points_.size()) - 1);
    const auto i = static_cast<std::size_t>(next);
    const double step = up_to_[i] - up_to_[i - 1], share = step > 0 ? (s - up_to_[i - 1]) / step : 0;
    return points_[i - 1].place + std::clamp(share, 0.0, 1.0) * (points_[i].place - points_[i - 1].place);
  }

  /// Angle by which the direction changes around a point, between chords of length `reach`, or what is there.
  double turn(std::size_t i, double reach) const {
    const auto clamped = [&](double s) { return closed_ ? s : std::clamp(s, 0.0, length()); };
    const double s = up_to_[i];
    const Vec3 before = points_[i].place - at(clamped(s - reach)), after = at(clamped(s + reach)) - points_[i].place;
    return std::atan2(norm(cross(before, after)), dot(before, after));
  }

  /// Indices of points where the direction changes by more than a sharp turn within `reach`, ascending.
  std::vector<std::size_t> turns(double reach) const {
    const double least = std::cos(sharp_turn * std::numbers::pi / 180);
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

  /// Where the straight continuations of both sides come nearest to each other; the point itself if that is far.
  Vec3 corner(std::size_t i, double reach, double most) const {
    const double s = up_to_[i];
    const Vec3 a = at(s - 0.7 * reach), u = normalized(a - at(s - 1.6 * reach));
    const Vec3 b = at(s + 0.7 * reach), v = normalized(b - at(s + 1.6 * reach));
    const Vec3 w = b - a, n = cross(u, v);
    const double n2 = squared_norm(n);
    if (!(n2 > 0.01)) return points_[i].place;
    const Vec3 p = a + (dot(cross(w, v), n) / n2) * u, q = b + (dot(cross(w, u), n) / n2) * v, middle = 0.5 * (p + q);
    return norm(middle - points_[i].place) < most && norm(p - q) < 0.2 * most ? middle : points_[i].place;
  }

 private:
  std::vector<Point> points_;
  bool closed_;
  std::vector<double> up_to_;
};

/// Makes chains of the network's paths.
class Chains {
 public:
  Chains(double edge, double spacing) : edge_(edge), spacing_(spacing) {}

  FeatureCurves make(Network& network) {
    for (const Path& path : network.paths()) {
      if (!path.alive) continue;
      std::vector<Point> points = network.points_between(path);
      if (path.from == none) {
        points.push_back(points.front());
        add(thinned(points, 0.8 * spacing_), none, none);
        continue;
      }
      const Index from = corner_at(network, path.from), to = corner_at(network, path.to);
      points.insert(points.begin(), {features_.corners[from], network.relative_sizing(path.from)});
      points.push_back({features_.corners[to], network.relative_sizing(path.to)});
      add(clear_of_ends(points), from, to);
    }
    return std::move(features_);
  }

 private:
  Index corner_at(Network& network, Index node) {
    const Index root = network.junction(node);
    const auto [it, added] = corner_of_.insert({root, static_cast<Index>(features_.corners.size())});
    if (added) features_.corners.push_back(network.place(root));
    return it->second;
  }

  /// Near a corner the planes of cubes are mixed: the way to it is straight.
  std::vector<Point> clear_of_ends(std::vector<Point> points) const {
    const Vec3 a = points.front().place, b = points.back().place;
    const double clear = 1.2 * spacing_;
    std::vector<Point> kept{points.front()};
    for (std::size_t i = 1; i + 1 < points.size(); ++i)
      if (norm(points[i].place - a) > clear && norm(points[i].place - b) > clear) kept.push_back(points[i]);
    kept.push_back(points.back());
    return thinned(kept, 0.8 * spacing_);
  }

  /// Adds the points as one chain, or as several if there are turns in it.
  void add(std::vector<Point> points, Index from, Index to) {
    const bool closed = from == none;
    const double reach = std::max(3 * spacing_, 0.25 * edge_);
    const Polyline line(points, closed);
    const std::vector<std::size_t> turns = line.turns(reach);
    if (turns.empty()) return add_curve(points, from, to);
    std::vector<Index> corners;
    for (const std::size_t i : turns) {
      corners.push_back(static_cast<Index>(features_.corners.size()));
      features_.corners.push_back(line.corner(i, reach, 3.5 * spacing_));
      points[i].place = features_.corners.back();
    }
    const auto piece = [&](std::size_t begin, std::size_t end) {
      return std::vector<Point>(points.begin() + static_cast<std::ptrdiff_t>(begin),
                                points.begin() + static_cast<std::ptrdiff_t>(end) + 1);
    };
    const std::size_t last = points.size() - 1;
    std::vector<Point> head = piece(0, turns.front()), tail = piece(turns.back(), last);
    if (closed) {
      tail.insert(tail.end(), head.begin() + 1, head.end());
      add_curve(clear_of_ends(tail), corners.back(), corners.front());
    } else {
      add_curve(clear_of_ends(head), from, corners.front());
      add_curve(clear_of_ends(tail), corners.back(), to);
    }
    for (std::size_t k = 0; k + 1 < turns.size(); ++k)
      add_curve(clear_of_ends(piece(turns[k], turns[k + 1])), corners[k], corners[k + 1]);
  }

  void add_curve(std::vector<Point> points, Index from, Index to) {
    FeatureCurve curve = curve_of(points, from, to);
    if (!(curve.points.size() > 1 && curve.length() > 0)) return;
    if (!follows(curve, edge_)) {
      tighten(points, from == none);
      curve = curve_of(points, from, to);
    }
    features_.curves.push_back(std::move(curve));
  }
  static FeatureCurve curve_of(const std::vector<Point>& points, Index from, Index to) {
    FeatureCurve curve;
    curve.from = from, curve.to = to;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double step = i == 0 ? 0
                                 : 0.5 * (points[i - 1].relative_sizing + points[i].relative_sizing) *
                                       norm(points[i].place - points[i - 1].place);
      curve.points.push_back(points[i].place);
      curve.arc.push_back((i == 0 ? 0 : curve.arc.back()) + step);
    }
    return curve;
  }

  /// Quickens the pace in strongly curved parts so that chords do not leave them by more than `feature_deviation`.
  void tighten(std::vector<Point>& points, bool closed) const {
    const Polyline line(points, closed);
    const double reach = std::max(2.5 * spacing_, 0.3 * edge_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double curvature = line.turn(i, reach) / reach;
      const double chord = std::sqrt(8 * feature_deviation * edge_ / std::max(curvature, 1e-9 / edge_));
      points[i].relative_sizing *= std::clamp(edge_ / chord, 1.0, max_tightened);
    }
  }

  double edge_, spacing_;
  FeatureCurves features_;
  std::map<Index, Index> corner_of_;
};

}  // namespace

FeatureCurves find_feature_curves(const SampleSet& samples, double angle, double edge, ExecutionContext& context) {
  const FeatureGraph graph = find_feature_graph(samples, std::cos(angle * std::numbers::pi / 180),
                                                std::cos(weak_angle * angle * std::numbers::pi / 180), context);
  if (graph.nodes.empty()) return {};
  Network network(graph, edge, samples.grid.spacing);
  network.set_origin(samples.grid.origin);
  network.clean();
  const FeatureCurves all = Chains(edge, samples.grid.spacing).make(network);
  FeatureCurves features = without_crowded(all, crowded_distance * edge);
  features.apexes = find_apexes(samples, graph.nodes, features, angle, edge, context);
  return features;
}

}  // namespace evenmesh
