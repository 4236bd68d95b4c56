#include "measure/topology.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "geometry/corners.h"

namespace evenmesh {
namespace {

/// Disjoint sets that several threads unite at once; the lower index becomes the root. Which items end up together does
/// not depend on the order.
class SharedSets {
 public:
  explicit SharedSets(std::size_t count) : parent_(count) {
    for (std::size_t i = 0; i < count; ++i) parent_[i].store(static_cast<std::uint32_t>(i), std::memory_order_relaxed);
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    for (;;) {
      a = find(a);
      b = find(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      std::uint32_t root = a;
      if (parent_[a].compare_exchange_strong(root, b, std::memory_order_relaxed)) return;
    }
  }
  /// Once nobody unites any more.
  std::size_t count() const {
    std::size_t roots = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) roots += parent_[i].load(std::memory_order_relaxed) == i;
    return roots;
  }

 private:
  /// With path halving: what is written is an ancestor still, whatever others have written meanwhile.
  std::uint32_t find(std::uint32_t x) {
    for (;;) {
      const std::uint32_t parent = parent_[x].load(std::memory_order_relaxed);
      if (parent == x) return x;
      const std::uint32_t above = parent_[parent].load(std::memory_order_relaxed);
      if (above != parent) parent_[x].store(above, std::memory_order_relaxed);
      x = above;
    }
  }

  std::vector<std::atomic<std::uint32_t>> parent_;
};

/// A side of a triangle, seen from one of its ends.
struct Side {
  std::uint32_t other;  ///< end
  std::uint32_t face;
  std::uint8_t first;  ///< corner of the face where the side starts
  bool away;           ///< starts here
};

/// What several pieces of the vertices add up to.
struct Tally {
  std::size_t edges = 0, boundary = 0, non_manifold = 0, inconsistent = 0;
  double length_sum = 0, length_squares = 0;

  void add_to(Topology& topology) const {
    topology.edges += edges;
    topology.boundary += boundary;
    topology.non_manifold += non_manifold;
    topology.inconsistent += inconsistent;
    topology.length_sum += length_sum;
    topology.length_squares += length_squares;
  }
};

/// Looks at one vertex after the other, and at each edge from both of its ends; counts it at the lower one.
class VertexWalker {
 public:
  VertexWalker(const Mesh& mesh, SharedSets& components, Tally& tally)
      : mesh_(mesh), components_(components), tally_(tally) {}

  /// @param corners  of the vertex, 3 · face + corner, ascending
  VertexState look_at(std::uint32_t vertex, std::span<const std::uint32_t> corners) {
    VertexState state;
    if (corners.empty()) return state;
    state.used = true;
    collect(vertex, corners);
    state.umbrellas = static_cast<std::uint32_t>(faces_.size());
    for (std::size_t begin = 0, end = 0; begin < sides_.size(); begin = end) {
      while (end < sides_.size() && sides_[end].other == sides_[begin].other) ++end;
      add_edge(vertex, std::span(sides_).subspan(begin, end - begin), state);
    }
    return state;
  }

 private:
  /// Sides by other end, face and first corner; and the faces, a repeated vertex having one corner in a triangle.
  void collect(std::uint32_t vertex, std::span<const std::uint32_t> corners) {
    sides_.clear();
    faces_.clear();
    for (const std::uint32_t corner : corners) {
      const std::uint32_t face = corner / 3;
      const auto at = static_cast<std::uint8_t>(corner % 3), before = static_cast<std::uint8_t>((at + 2) % 3);
      const Triangle& t = mesh_.triangles[face];
      sides_.push_back({t[(at + 1u) % 3], face, at, true});
      if (t[before] != vertex) sides_.push_back({t[before], face, before, false});  // else it came from the other end
      if (faces_.empty() || faces_.back() != face) faces_.push_back(face);
    }
    const auto earlier = [](const Side& a, const Side& b) {
      return a.other != b.other ? a.other < b.other : a.face != b.face ? a.face < b.face : a.first < b.first;
    };
    std::sort(sides_.begin(), sides_.end(), earlier);
    umbrella_.resize(faces_.size());
    std::iota(umbrella_.begin(), umbrella_.end(), 0u);
  }

  /// @param sides  all that join the vertex and one other
  void add_edge(std::uint32_t vertex, std::span<const Side> sides, VertexState& state) {
    const std::uint32_t other = sides[0].other;
    state.valence += vertex == other ? 2 : 1;
    state.on_boundary |= sides.size() == 1;
    state.on_non_manifold_edge |= sides.size() > 2;
    if (sides.size() == 2 && unite_umbrellas(sides[0].face, sides[1].face)) --state.umbrellas;
    if (other < vertex) return;
    ++tally_.edges;
    tally_.boundary += sides.size() == 1;
    tally_.non_manifold += sides.size() > 2;
    tally_.inconsistent += sides.size() == 2 && sides[0].away == sides[1].away;
    const double squared = squared_norm(mesh_.vertices[other] - mesh_.vertices[vertex]);
    tally_.length_sum += std::sqrt(squared);
    tally_.length_squares += squared;
    for (const Side& side : sides.subspan(1)) components_.unite(sides[0].face, side.face);
  }

  std::uint32_t umbrella_of(std::uint32_t face) {
    auto at = static_cast<std::uint32_t>(std::lower_bound(faces_.begin(), faces_.end(), face) - faces_.begin());
    while (umbrella_[at] != at) {
      umbrella_[at] = umbrella_[umbrella_[at]];
      at = umbrella_[at];
    }
    return at;
  }
  /// Whether two different umbrellas became one.
  bool unite_umbrellas(std::uint32_t face, std::uint32_t other) {
    const std::uint32_t a = umbrella_of(face), b = umbrella_of(other);
    umbrella_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

  const Mesh& mesh_;
  SharedSets& components_;
  Tally& tally_;
  std::vector<Side> sides_;
  std::vector<std::uint32_t> faces_;     ///< around the vertex, ascending
  std::vector<std::uint32_t> umbrella_;  ///< disjoint sets of them
};

}  // namespace

Topology measure_topology(const Mesh& mesh, const ExecutionContext& context) {
  constexpr std::size_t piece = 4096;
  const std::size_t vertices = mesh.vertices.size();
  const Groups corners = corners_by_vertex(mesh.triangles, vertices, context);
  Topology topology;
  topology.vertices.resize(vertices);
  SharedSets components(mesh.triangles.size());
  std::vector<Tally> tallies((vertices + piece - 1) / piece);
  parallel_tasks(context, tallies.size(), [&](std::size_t p) {
    VertexWalker walker(mesh, components, tallies[p]);
    for (std::size_t v = p * piece; v < std::min(vertices, (p + 1) * piece); ++v)
      topology.vertices[v] = walker.look_at(static_cast<std::uint32_t>(v), corners.of(v));
  });
  for (const Tally& tally : tallies) tally.add_to(topology);
  topology.components = components.count();
  return topology;
}

}  // namespace evenmesh
