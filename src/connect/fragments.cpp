#include "connect/fragments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "connect/seed_graph.h"

namespace evenmesh {
namespace {

using Index = std::uint32_t;

SeedEdge ordered(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

template <typename Item>
bool has(const std::vector<Item>& sorted, const Item& item) {
  return std::binary_search(sorted.begin(), sorted.end(), item);
}

/// Cycle of seeds, filled up with no_seed; from the lowest seed towards the lower of its neighbours.
struct Cycle {
  std::size_t length = 0;
  SeedGroup seeds{};
  friend auto operator<=>(const Cycle&, const Cycle&) = default;
};

/// The edges of a mesh in the making, and how many triangles each has.
class EdgeTable {
 public:
  explicit EdgeTable(const std::vector<SeedEdge>& delaunay) : sides_(delaunay), uses_(delaunay.size()) {}

  bool is_delaunay(Index a, Index b) const { return has(sides_, ordered(a, b)); }
  std::size_t uses(Index a, Index b) const {
    const SeedEdge edge = ordered(a, b);
    if (const auto it = std::lower_bound(sides_.begin(), sides_.end(), edge); it != sides_.end() && *it == edge)
      return uses_[static_cast<std::size_t>(it - sides_.begin())].count;
    const auto it = std::lower_bound(diagonals_.begin(), diagonals_.end(), std::pair{edge, Use{}}, by_edge);
    return it != diagonals_.end() && it->first == edge ? it->second.count : 0;
  }
  /// A triangle of a cycle of this length: its edges, and what of them are diagonals of that cycle.
  void add(const Triangle& t, std::size_t cycle) {
    for (std::size_t c = 0; c < 3; ++c) {
      Use& use = at(ordered(t[c], t[(c + 1) % 3]));
      use.cycle = use.count == 0 ? cycle : std::min(use.cycle, cycle);
      ++use.count;
    }
  }
  void remove(const Triangle& t) {
    for (std::size_t c = 0; c < 3; ++c) --at(ordered(t[c], t[(c + 1) % 3])).count;
  }
  /// Calls visit(edge, triangles, cycle) for all Delaunay edges, with triangles or without, and all diagonals.
  template <typename Visit>
  void for_edges(const Visit& visit) const {
    for (std::size_t e = 0; e < sides_.size(); ++e) visit(sides_[e], uses_[e].count, uses_[e].cycle);
    for (const auto& [edge, use] : diagonals_) visit(edge, use.count, use.cycle);
  }

 private:
  struct Use {
    std::size_t count = 0, cycle = 0;  ///< triangles, and the shortest cycle that one of them comes from
  };
  static bool by_edge(const std::pair<SeedEdge, Use>& a, const std::pair<SeedEdge, Use>& b) {
    return a.first < b.first;
  }
  Use& at(const SeedEdge& edge) {
    if (const auto it = std::lower_bound(sides_.begin(), sides_.end(), edge); it != sides_.end() && *it == edge)
      return uses_[static_cast<std::size_t>(it - sides_.begin())];
    const auto it = std::lower_bound(diagonals_.begin(), diagonals_.end(), std::pair{edge, Use{}}, by_edge);
    if (it != diagonals_.end() && it->first == edge) return it->second;
    return diagonals_.insert(it, {edge, Use{}})->second;
  }

  const std::vector<SeedEdge>& sides_;
  std::vector<Use> uses_;
  std::vector<std::pair<SeedEdge, Use>> diagonals_;  ///< few
};

class Extraction {
 public:
  Extraction(const SeedGraph& graph, std::size_t seeds, const FragmentOptions& options)
      : graph_(graph), options_(options), edges_(graph.delaunay), start_(seeds + 1, 0) {
    for (const auto& [a, b] : graph.delaunay) ++start_[a + 1];
    for (std::size_t s = 0; s < seeds; ++s) start_[s + 1] += start_[s];
  }

  void run(Fragments& result) {
    find_triangles();
    result.left_out = thin_crowded();
    fill_cycles();
    result.left_out += peel_flaps();
    result.complex.triangles = std::move(triangles_);
    result.complex.edges_by_cycle.assign(options_.max_cycle - 2, 0);
    edges_.for_edges([&](const SeedEdge& edge, std::size_t count, std::size_t cycle) {
      if (count > 0) ++result.complex.edges_by_cycle[cycle - 3];
      const bool lacks = count < 2 && !(count == 0 && has(bare_, edge));
      if (count > 2 || (lacks && !options_.open)) result.complex.defects.push_back(edge);
    });
  }

 private:
  /// The Delaunay edges to higher seeds.
  std::span<const SeedEdge> edges_up(Index seed) const {
    return std::span(graph_.delaunay).subspan(start_[seed], start_[seed + 1] - start_[seed]);
  }

  void find_triangles() {
    for (const auto& [a, b] : graph_.delaunay)
      for (const auto& [from, c] : edges_up(b))
        if (edges_.is_delaunay(a, c)) triangles_.push_back({a, b, c});
    for (const Triangle& t : triangles_) edges_.add(t, 3);
  }

  bool is_crowded(const Triangle& t) const {
    return edges_.uses(t[0], t[1]) > 2 || edges_.uses(t[1], t[2]) > 2 || edges_.uses(t[2], t[0]) > 2;
  }

  /// Three seeds around a fourth, or around a tube, are a cycle without being a face: no sample has them as its
  /// nearest.
  std::size_t thin_crowded() {
    std::vector<Triangle> kept, gone;
    for (const Triangle& t : triangles_)
      (is_crowded(t) && !has(graph_.corners, std::array{t[0], t[1], t[2]}) ? gone : kept).push_back(t);
    for (const Triangle& t : gone) edges_.remove(t);
    triangles_ = std::move(kept);
    return gone.size();
  }

  /// Longer cycles, short ones first. Each side may take one more triangle: what is full already lies around the cycle.
  void fill_cycles() {
    for (const SeedGroup& group : graph_.groups)
      for (std::size_t first = 0; first < largest_group && group[first] != no_seed; ++first) {
        path_.assign(1, group[first]);
        extend_path(group, first);
      }
    std::sort(cycles_.begin(), cycles_.end());
    cycles_.erase(std::unique(cycles_.begin(), cycles_.end()), cycles_.end());
    for (const Cycle& cycle : cycles_) fill(cycle);
  }

  /// Grows a path without chords from the lowest seed of a cycle; every cycle is found in one direction.
  void extend_path(const SeedGroup& group, std::size_t first) {
    for (std::size_t g = first + 1; g < largest_group && group[g] != no_seed; ++g) {
      const Index next = group[g];
      if (std::find(path_.begin(), path_.end(), next) != path_.end() || !edges_.is_delaunay(path_.back(), next))
        continue;
      bool has_chord = false;
      for (std::size_t i = 1; i + 1 < path_.size(); ++i) has_chord |= edges_.is_delaunay(path_[i], next);
      if (has_chord) continue;
      const bool closes = path_.size() > 1 && edges_.is_delaunay(path_[0], next);
      path_.push_back(next);
      if (!closes && path_.size() < options_.max_cycle)
        extend_path(group, first);
      else if (closes && path_.size() > 3 && path_[1] < next)
        add_cycle();
      path_.pop_back();
    }
  }
  void add_cycle() {
    Cycle cycle{path_.size(), {}};
    cycle.seeds.fill(no_seed);
    std::copy(path_.begin(), path_.end(), cycle.seeds.begin());
    cycles_.push_back(cycle);
  }

  void fill(const Cycle& cycle) {
    const std::size_t n = cycle.length;
    for (std::size_t i = 0; i < n; ++i)
      if (edges_.uses(cycle.seeds[i], cycle.seeds[(i + 1) % n]) > 1) return;
    std::size_t center = n;
    for (std::size_t i = 0; i < n; ++i)
      if (sees_all(cycle, i) && (center == n || cycle.seeds[i] < cycle.seeds[center])) center = i;
    if (center == n) return;
    for (std::size_t i = 1; i + 1 < n; ++i) {
      Triangle t{cycle.seeds[center], cycle.seeds[(center + i) % n], cycle.seeds[(center + i + 1) % n]};
      edges_.add(t, n);
      triangles_.push_back(t);
    }
  }

  /// Whether a fan around this seed of the cycle consists of edges of either kind, none of them in use.
  bool sees_all(const Cycle& cycle, std::size_t from) const {
    for (std::size_t i = 2; i + 1 < cycle.length; ++i) {
      const SeedEdge diagonal = ordered(cycle.seeds[from], cycle.seeds[(from + i) % cycle.length]);
      if (!has(graph_.candidates, diagonal) || edges_.uses(diagonal.first, diagonal.second) > 0) return false;
    }
    return true;
  }

  /// Triangles that stand on a crowded edge with a free edge above are no part of the surface; one after the other.
  std::size_t peel_flaps() {
    std::size_t peeled = 0;
    for (std::size_t last = 1; last > 0;) {
      last = std::erase_if(triangles_, [&](const Triangle& t) {
        if (!is_crowded(t) || !has_free_edge(t)) return false;
        edges_.remove(t);
        for (std::size_t c = 0; c < 3; ++c)
          if (edges_.uses(t[c], t[(c + 1) % 3]) == 0) bare_.push_back(ordered(t[c], t[(c + 1) % 3]));
        return true;
      });
      peeled += last;
    }
    std::sort(bare_.begin(), bare_.end());
    return peeled;
  }
  bool has_free_edge(const Triangle& t) const {
    return edges_.uses(t[0], t[1]) == 1 || edges_.uses(t[1], t[2]) == 1 || edges_.uses(t[2], t[0]) == 1;
  }

  const SeedGraph& graph_;
  const FragmentOptions& options_;
  EdgeTable edges_;
  std::vector<std::size_t> start_;  ///< of the edges from each seed to higher ones
  std::vector<Triangle> triangles_;
  std::vector<SeedEdge> bare_;  ///< edges of flaps
  std::vector<Index> path_;
  std::vector<Cycle> cycles_;
};

/// Turns triangles so that neighbours agree, and most of a part agree with the normals of the samples at their seeds.
class Orientation {
 public:
  Orientation(std::vector<Triangle>& triangles, std::span<const Vec3> seeds, std::span<const Vec3> normals)
      : triangles_(triangles), seeds_(seeds), normals_(normals), part_(triangles.size(), none) {
    for (Index t = 0; t < triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        sides_.push_back({ordered(triangles[t][c], triangles[t][(c + 1) % 3]), static_cast<Index>(3 * t + c)});
    std::sort(sides_.begin(), sides_.end());
    across_.assign(3 * triangles.size(), none);
    for (std::size_t i = 0; i < sides_.size(); i += run_at(i))
      if (run_at(i) == 2) {
        across_[sides_[i].second] = sides_[i + 1].second;
        across_[sides_[i + 1].second] = sides_[i].second;
      }
  }

  /// Returns the edges whose two triangles cannot agree: the surface has one side only.
  std::vector<SeedEdge> settle() {
    for (Index t = 0; t < triangles_.size(); ++t)
      if (part_[t] == none) settle_part(t);
    std::vector<SeedEdge> torn;
    for (Index h = 0; h < across_.size(); ++h)
      if (across_[h] != none && h < across_[h] && !agree(h, across_[h])) torn.push_back(ordered(from(h), to(h)));
    return torn;
  }

 private:
  static constexpr Index none = 0xffffffffu;

  std::size_t run_at(std::size_t i) const {
    std::size_t end = i + 1;
    while (end < sides_.size() && sides_[end].first == sides_[i].first) ++end;
    return end - i;
  }
  // A triangle that is turned has its last two corners exchanged: sides are found by their ends, as they were at first.
  Index from(Index h) const { return first_corner(h, 0); }
  Index to(Index h) const { return first_corner(h, 1); }
  Index first_corner(Index h, std::size_t end) const {
    const Triangle& t = triangles_[h / 3];
    const std::size_t c = (h % 3 + end) % 3;
    return t[turned_[h / 3] && c > 0 ? 3 - c : c];
  }
  bool agree(Index h, Index g) const {
    const bool same_way = from(h) == from(g);
    return same_way == (turned_[h / 3] != turned_[g / 3]);
  }
  void turn(Index t) {
    std::swap(triangles_[t][1], triangles_[t][2]);
    turned_[t] = !turned_[t];
  }

  /// By how much the triangle agrees with the normals at its seeds, as its area.
  double vote(Index t) const {
    const Triangle& c = triangles_[t];
    return dot(cross(seeds_[c[1]] - seeds_[c[0]], seeds_[c[2]] - seeds_[c[0]]),
               normals_[c[0]] + normals_[c[1]] + normals_[c[2]]);
  }

  void settle_part(Index first) {
    std::vector<Index> part{first};
    part_[first] = first;
    double votes = vote(first);
    for (std::size_t at = 0; at < part.size(); ++at)
      for (Index h = 3 * part[at]; h < 3 * part[at] + 3; ++h) {
        if (across_[h] == none) continue;
        const Index neighbour = across_[h] / 3;
        if (part_[neighbour] != none) continue;
        part_[neighbour] = first;
        if (!agree(h, across_[h])) turn(neighbour);
        votes += vote(neighbour);
        part.push_back(neighbour);
      }
    if (votes < 0)
      for (const Index t : part) turn(t);
  }

  std::vector<Triangle>& triangles_;
  std::span<const Vec3> seeds_, normals_;
  std::vector<std::pair<SeedEdge, Index>> sides_;
  std::vector<Index> across_, part_;
  std::vector<char> turned_ = std::vector<char>(triangles_.size(), 0);
};

std::vector<Vec3> normals_at_seeds(const SampleSet& samples, const std::vector<Index>& nearest, std::size_t seeds) {
  std::vector<Vec3> normals(seeds);
  for (std::size_t i = 0; i < samples.size(); ++i)
    normals[nearest[i]] += double(samples.area[i]) * unpack_normal(samples.normal[i]);
  for (Vec3& n : normals) n = normalized(n);
  return normals;
}

}  // namespace

Fragments connect_fragments(const SampleSet& samples, std::span<const Vec3> seeds, const FragmentOptions& options,
                            ExecutionContext& context) {
  const double margin = options.margin > 0 ? options.margin : std::numbers::sqrt3 * samples.grid.spacing;
  SeedGraph graph = seed_graph(samples, seeds, margin, context);
  Fragments result;
  result.complex.labels = seeds.size();
  if (seeds.empty()) return result;
  Extraction(graph, seeds.size(), options).run(result);
  const std::vector<Vec3> normals = normals_at_seeds(samples, graph.nearest, seeds.size());
  const auto torn = Orientation(result.complex.triangles, seeds, normals).settle();
  auto& defects = result.complex.defects;
  defects.insert(defects.end(), torn.begin(), torn.end());
  std::sort(defects.begin(), defects.end());
  defects.erase(std::unique(defects.begin(), defects.end()), defects.end());
  result.delaunay = std::move(graph.delaunay);
  result.candidates = std::move(graph.candidates);
  return result;
}

}  // namespace evenmesh
