#include "geometry/sidedness.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "core/parallel.h"

namespace evenmesh {
namespace {

/// A number for an edge that no other is likely to have (the finalizer of splitmix64).
std::uint64_t mark_of(std::uint32_t low, std::uint32_t high) {
  std::uint64_t h = (std::uint64_t{low} << 32 | high) + 0x9e3779b97f4a7c15u;
  h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
  h = (h ^ h >> 27) * 0x94d049bb133111ebu;
  return h ^ h >> 31;
}

/// Calls visit(lower vertex, higher vertex, whether the edge runs upwards) for every side of a triangle.
template <typename Visit>
void visit_sides(const Triangle& t, const Visit& visit) {
  for (std::size_t c = 0; c < 3; ++c) {
    const std::uint32_t a = t[c], b = t[(c + 1) % 3];
    visit(std::min(a, b), std::max(a, b), a < b);
  }
}

/// Every edge runs as often one way as the other: closed, and facing one way.
bool is_oriented(const Mesh& mesh) {
  std::uint64_t sum = 0;
  for (const Triangle& t : mesh.triangles)
    visit_sides(t, [&](std::uint32_t low, std::uint32_t high, bool up) {
      const std::uint64_t mark = mark_of(low, high);
      sum += up ? mark : -mark;
    });
  return sum == 0;
}

/// Disjoint sets of triangles, each with the side it faces relative to its set's root.
class FacingSets {
 public:
  explicit FacingSets(std::size_t size) : parent_(size), turned_(size, 0), one_sided_(size, 0) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }

  void join(std::uint32_t a, std::uint32_t b, bool agree) {
    const auto [root_a, turn_a] = find(a);
    const auto [root_b, turn_b] = find(b);
    const bool turn = turn_a ^ turn_b ^ !agree;
    if (root_a == root_b) {
      one_sided_[root_a] = one_sided_[root_a] || turn;
      return;
    }
    parent_[root_b] = root_a;
    turned_[root_b] = turn;
    one_sided_[root_a] = one_sided_[root_a] || one_sided_[root_b];
  }
  bool one_sided(std::uint32_t t) { return one_sided_[find(t).first]; }

 private:
  /// The root, and whether the triangle faces the other way. Halves the way there.
  std::pair<std::uint32_t, bool> find(std::uint32_t t) {
    bool turn = false;
    while (parent_[t] != t) {
      const std::uint32_t p = parent_[t];
      turned_[t] = turned_[t] ^ (parent_[p] == p ? 0 : turned_[p]);
      parent_[t] = parent_[p];
      turn = turn ^ (turned_[t] != 0);
      t = parent_[t];
    }
    return {t, turn};
  }

  std::vector<std::uint32_t> parent_;
  std::vector<char> turned_, one_sided_;
};

struct Side {
  std::uint32_t low = 0, high = 0;
  std::uint32_t code = 0;  ///< twice the triangle, plus 1 where the edge runs upwards
  friend auto operator<=>(const Side&, const Side&) = default;
};

std::vector<Side> sorted_sides(const Mesh& mesh, const ExecutionContext& context) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    visit_sides(mesh.triangles[t], [&](std::uint32_t low, std::uint32_t high, bool up) {
      if (low != high) sides.push_back({low, high, 2 * t + up});
    });
  parallel_sort(context, sides);
  return sides;
}

}  // namespace

bool is_closed(const Mesh& mesh) {
  std::uint64_t odd = 0;
  for (const Triangle& t : mesh.triangles)
    visit_sides(t, [&](std::uint32_t low, std::uint32_t high, bool) { odd ^= mark_of(low, high); });
  return odd == 0;
}

std::size_t one_sided_triangles(const Mesh& mesh, const ExecutionContext& context) {
  if (is_oriented(mesh)) return 0;
  const std::vector<Side> sides = sorted_sides(mesh, context);
  FacingSets sets(mesh.triangles.size());
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    if (end - begin == 2)
      sets.join(sides[begin].code / 2, sides[begin + 1].code / 2, (sides[begin].code ^ sides[begin + 1].code) & 1);
  }
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) count += sets.one_sided(t);
  return count;
}

}  // namespace evenmesh
