#include "features/feature_network.h"

#include <algorithm>
#include <map>

#include "geometry/union_find.h"

namespace evenmesh {
namespace {

using Index = std::uint32_t;
constexpr Index none = FeaturePath::none;
constexpr double min_length = 3;  ///< of connected curves together, in edges, and five times that for every loose end
/// Connected curves that are no noise even where most of what bends is not sharp: so long, in edges and compared with
/// all that bends, where they are sharp, or clear, along nine tenths.
constexpr double sharp_length = 20, sharp_extent = 0.05, clear_length = 6, clear_extent = 0.03;
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
        noisy_(is_noisy(graph)),
        extent_(extent(graph)),
        joined_(graph.nodes.size()),
        planes_(graph.nodes.size()) {
    for (Index v = 0; v < planes_.size(); ++v) planes_[v] = graph.nodes[v].planes;
    list_links();
    trace();
  }

  void clean() {
    if (noisy_) drop_fading_paths();
    for (bool changed = true; changed;) {
      changed = prune();
      changed |= contract();
      changed |= join_at_passings();
    }
    drop_small_parts();
  }

  FeatureNetwork result() {
    FeatureNetwork network;
    network.left_out = std::move(left_out_);
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
      auto& list = graph_.sharpness[i] == Sharpness::weak ? weak : links_;
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

  /// Connected paths; a closed one is alone.
  struct Part {
    double length = 0;
    std::size_t loose_ends = 0, links = 0, weak = 0, clear = 0;
    bool fades() const { return 10 * weak > links; }
  };

  void drop_small_parts() {
    UnionFind joined(joined_.size());
    for (const Path& path : paths_)
      if (path.alive && path.from != none) joined.unite(junction(path.from), junction(path.to));
    std::vector<Index> part_of(paths_.size(), none);
    std::vector<Part> parts(joined_.size());
    for (Index p = 0; p < paths_.size(); ++p) {
      if (!paths_[p].alive) continue;
      const bool closed = paths_[p].from == none;
      part_of[p] = closed ? static_cast<Index>(parts.size()) : joined.find(junction(paths_[p].from));
      if (closed) parts.emplace_back();
      add(paths_[p], parts[part_of[p]]);
    }
    const std::vector<Index> count = degrees();
    for (Index v = 0; v < count.size(); ++v)
      if (count[v] == 1) ++parts[joined.find(v)].loose_ends;
    for (Index p = 0; p < paths_.size(); ++p)
      if (part_of[p] != none) judge(paths_[p], parts[part_of[p]]);
    degrees_.clear();
  }
  void add(const Path& path, Part& part) const {
    part.length += path.length;
    for (std::size_t i = 0; i + 1 < path.nodes.size(); ++i)
      for (const Link& link : links_[path.nodes[i]])
        if (link.other == path.nodes[i + 1]) {
          ++part.links;
          part.weak += graph_.sharpness[link.id] == Sharpness::weak;
          part.clear += graph_.sharpness[link.id] == Sharpness::clear;
        }
  }
  /// What is sharp here and there only must not hang noise on the edges that are sharp.
  void drop_fading_paths() {
    for (Path& path : paths_) {
      Part alone;
      add(path, alone);
      if (alone.fades()) path.alive = false;
    }
  }
  void judge(Path& path, const Part& part) {
    const double ends = static_cast<double>(part.loose_ends);
    const auto is_long = [&](double edges, double extent) {
      return part.length >= std::max(edges * edge_, extent * extent_);
    };
    const bool sharp = !part.fades() && is_long(sharp_length, sharp_extent);
    const bool clear = 10 * part.clear >= 9 * part.links && is_long(clear_length, clear_extent);
    if (noisy_ && !sharp && !clear) path.alive = false;
    if (part.length >= min_length * (1 + 5 * ends) * edge_) return;
    if (path.alive && !noisy_ && ends == 0 && !path.nodes.empty())
      left_out_.push_back(graph_.nodes[path.nodes[path.nodes.size() / 2]].place);
    path.alive = false;
  }

  static double extent(const FeatureGraph& graph) {
    Box box;
    for (const FeatureNode& node : graph.nodes) box.add(node.place);
    return box.longest_side();
  }
  /// Whether most of what bends is not sharp.
  static bool is_noisy(const FeatureGraph& graph) {
    const auto weak = std::count(graph.sharpness.begin(), graph.sharpness.end(), Sharpness::weak);
    return 2 * static_cast<std::size_t>(weak) > graph.links.size();
  }

  const FeatureGraph& graph_;
  Vec3 origin_;
  double spacing_, edge_;
  bool noisy_;
  double extent_;  ///< of all that bends
  std::vector<Vec3> left_out_;
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
