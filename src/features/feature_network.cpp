#include "features/feature_network.h"

#include <algorithm>
#include <map>

#include "geometry/union_find.h"

namespace evenmesh {
namespace {

using Index = std::uint32_t;
constexpr Index none = FeaturePath::none;
constexpr double min_length = 3;  ///< of connected curves together, in edges, and five times that for every loose end
constexpr double loop_length = 1.5;      ///< of a loop from a corner to itself, in edges
constexpr double spur_length = 0.7;      ///< of a branch that ends nowhere, in edges
constexpr double corner_distance = 0.2;  ///< corners nearer than this, in edges, are one

/// A path of nodes between two junctions, or a closed one.
struct Path {
  Index from = none, to = none;  ///< junctions: nodes with one, three or more links
  std::vector<Index> nodes;      ///< those between them; all of a closed path
  double length = 0;             ///< model units
  bool alive = true;
};

/// The graph's paths between junctions, cleaned: no noise, no junctions next to each other.
class Network {
 public:
  Network(const FeatureGraph& graph, const Vec3& origin, double spacing, double edge)
      : graph_(graph),
        origin_(origin),
        spacing_(spacing),
        edge_(edge),
        joined_(graph.nodes.size()),
        planes_(graph.nodes.size()) {
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

  FeatureNetwork result() {
    FeatureNetwork network;
    std::map<Index, Index> number_of;
    const auto number = [&](Index node) {
      const Index root = junction(node);
      const auto [it, added] = number_of.insert({root, static_cast<Index>(network.junctions.size())});
      if (added) network.junctions.push_back(place(root));
      return it->second;
    };
    for (const Path& path : paths_) {
      if (!path.alive) continue;
      FeaturePath found{.points = points_between(path)};
      if (path.from == none) {
        found.points.push_back(found.points.front());
      } else {
        found.from = number(path.from);
        found.to = number(path.to);
        found.points.insert(found.points.begin(), point_at(path.from, network.junctions[found.from]));
        found.points.push_back(point_at(path.to, network.junctions[found.to]));
      }
      network.paths.push_back(std::move(found));
    }
    return network;
  }

 private:
  struct Link {
    Index other, id;
  };

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

  PolylinePoint point_at(Index node, const Vec3& place) const { return {place, graph_.nodes[node].relative_sizing}; }
  std::vector<PolylinePoint> points_between(const Path& path) const {
    std::vector<PolylinePoint> points;
    for (const Index v : path.nodes) points.push_back(point_at(v, graph_.nodes[v].place));
    return points;
  }

  /// The sharp links, and the weak ones that continue them.
  void list_links() {
    links_.resize(graph_.nodes.size());
    std::vector<std::vector<Link>> weak(graph_.nodes.size());
    for (Index i = 0; i < graph_.links.size(); ++i) {
      const auto [a, b] = graph_.links[i];
      auto& list = graph_.sharp[i] ? links_ : weak;
      list[a].push_back({b, i});
      list[b].push_back({a, i});
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
      links_[v].push_back(ways[0]);
      links_[next].push_back({v, ways[0].id});
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
    if (links_[v].size() == 2) {
      path.nodes.push_back(v);
      path.from = path.to = none;
    }
    return path;
  }

  void add_path(Path path) {
    measure(path);
    paths_.push_back(std::move(path));
  }
  void measure(Path& path) const {
    std::vector<PolylinePoint> points = points_between(path);
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
      if (path.alive && path.from != none) {
        ++count[junction(path.from)];
        ++count[junction(path.to)];
      }
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
      if (spur || loop) {
        path.alive = false;
        changed = true;
      }
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
    const std::vector<std::vector<Index>> long_paths =
        order.empty() ? std::vector<std::vector<Index>>{} : paths_longer_than_edge();
    bool changed = false;
    for (const auto& [length, p] : order) {
      Path& path = paths_[p];
      const Index a = junction(path.from), b = junction(path.to);
      if (a == b || count[a] < 2 || count[b] < 2 || crosses_rims(path, a, b, long_paths)) continue;
      joined_.unite(a, b);
      const Index root = junction(a), other = root == a ? b : a;
      merge_into(root, other);
      for (const Index v : path.nodes) {
        planes_[root].add(graph_.nodes[v].planes);
        members_[root].push_back(v);
      }
      path.alive = false;
      changed = true;
    }
    return changed;
  }
  /// By junction.
  std::vector<std::vector<Index>> paths_longer_than_edge() {
    std::vector<std::vector<Index>> at(joined_.size());
    for (Index p = 0; p < paths_.size(); ++p)
      if (paths_[p].alive && paths_[p].from != none && paths_[p].length > edge_ && !paths_[p].nodes.empty())
        for (const Index end : {junction(paths_[p].from), junction(paths_[p].to)}) at[end].push_back(p);
    return at;
  }
  /// Whether a path leads from one rim of a thin part to the other, each of which goes on along two paths at least.
  bool crosses_rims(const Path& path, Index a, Index b, const std::vector<std::vector<Index>>& long_paths) {
    if (path.length < 2 * spacing_ || long_paths[a].size() < 2 || long_paths[b].size() < 2) return false;
    const Vec3 across = normalized(graph_.nodes[b].place - graph_.nodes[a].place);
    for (const Index p : long_paths[a])
      for (const Index q : long_paths[b])
        if (face_apart(node_beside(paths_[p], a), node_beside(paths_[q], b), across)) return true;
    return false;
  }
  /// Of a path, clear of the junction that it begins or ends at.
  const FeatureNode& node_beside(const Path& path, Index junction_there) {
    const std::size_t step = std::min<std::size_t>(3, path.nodes.size() - 1);
    const bool begins = junction(path.from) == junction_there;
    return graph_.nodes[begins ? path.nodes[step] : path.nodes[path.nodes.size() - 1 - step]];
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
  Vec3 origin_;
  double spacing_, edge_;
  std::vector<std::vector<Link>> links_;
  std::vector<Path> paths_;
  UnionFind joined_;                             ///< nodes that are one junction
  std::vector<Quadric> planes_;                  ///< by junction
  std::map<Index, std::vector<Index>> members_;  ///< by junction: the other nodes that are part of it
  std::vector<Index> degrees_;
};

}  // namespace

FeatureNetwork find_feature_network(const FeatureGraph& graph, const Vec3& origin, double spacing, double edge) {
  Network network(graph, origin, spacing, edge);
  network.clean();
  return network.result();
}

}  // namespace evenmesh
