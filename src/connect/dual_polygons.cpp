#include "connect/dual_polygons.h"

#include <algorithm>
#include <set>

#include "core/parallel.h"
#include "geometry/half_edges.h"

namespace evenmesh {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;
Pair ordered(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

using Polygon = std::vector<std::uint32_t>;

/// A polygon that is no triangle, or visits a label twice.
struct Odd {
  Polygon corners;
  std::size_t triangle = 0;  ///< where its triangles go
  bool repeated = false;
};

/// Some lists of polygons: done in parallel with others.
class Part {
 public:
  std::vector<Triangle> triangles;
  std::vector<Odd> odd;
  std::vector<Pair> sides;

  Part() = default;
  Part(std::span<const std::vector<std::uint32_t>> polygons, std::span<const std::uint32_t> labels)
      : polygons_(polygons), labels_(labels) {}

  void make_triangles() {
    for_polygons([&](const Polygon& polygon) {
      const bool repeated = has_repeated(polygon);
      if (repeated || polygon.size() > 3) odd.push_back({polygon, triangles.size(), repeated});
      if (!repeated && polygon.size() == 3) triangles.push_back({polygon[0], polygon[1], polygon[2]});
      if (!repeated && polygon.size() > 3) triangles.resize(triangles.size() + polygon.size() - 2);
    });
  }
  /// Those between two vertices that are concerned.
  void find_sides(const std::vector<char>& concerned) {
    for_polygons([&](const Polygon& polygon) {
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const std::uint32_t v = polygon[i], w = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        if (v < w && concerned[v] && concerned[w]) sides.push_back({v, w});  // w < v comes from the polygon across
      }
    });
  }

 private:
  template <typename Visit>
  void for_polygons(const Visit& visit) const {
    Polygon polygon;
    for (const auto& list : polygons_)
      for (std::size_t at = 0; at < list.size(); at += list[at] + 1) {
        polygon.clear();
        for (std::uint32_t i = 1; i <= list[at]; ++i) polygon.push_back(labels_[list[at + i]]);
        visit(polygon);
      }
  }
  static bool has_repeated(const Polygon& polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i)
      if (std::find(polygon.begin() + static_cast<std::ptrdiff_t>(i) + 1, polygon.end(), polygon[i]) != polygon.end())
        return true;
    return false;
  }

  std::span<const std::vector<std::uint32_t>> polygons_;
  std::span<const std::uint32_t> labels_;
};

/// Edges that diagonals must not double: those of all polygons between corners of polygons with four corners and more,
/// and the diagonals drawn so far.
class TakenEdges {
 public:
  TakenEdges(std::vector<Part>& parts, std::size_t vertices, const ExecutionContext& context) {
    std::vector<char> concerned(vertices, 0);
    for (const Part& part : parts)
      for (const Odd& odd : part.odd)
        if (odd.corners.size() > 3)
          for (const std::uint32_t v : odd.corners) concerned[v] = 1;
    parallel_tasks(context, parts.size(), [&](std::size_t p) { parts[p].find_sides(concerned); });
    for (const Part& part : parts) sides_.insert(sides_.end(), part.sides.begin(), part.sides.end());
    parallel_sort(context, sides_);
  }
  bool has(std::uint32_t a, std::uint32_t b) const {
    const Pair edge = ordered(a, b);
    return std::binary_search(sides_.begin(), sides_.end(), edge) || diagonals_.contains(edge);
  }
  void add(std::uint32_t a, std::uint32_t b) { diagonals_.insert(ordered(a, b)); }

 private:
  std::vector<Pair> sides_;
  std::set<Pair> diagonals_;
};

/// Cuts off the corner with the shortest diagonal that is no edge yet, until a triangle is left.
/// @param triangles  room for two less than there are corners
void cut_ears(std::vector<std::uint32_t>& polygon, std::span<const Vec3> positions, TakenEdges& taken,
              Triangle* triangles) {
  while (polygon.size() > 3) {
    const std::size_t n = polygon.size();
    std::size_t ear = 0;
    double shortest = std::numeric_limits<double>::infinity();
    bool ear_taken = true;
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t before = polygon[(i + n - 1) % n], after = polygon[(i + 1) % n];
      const double length = squared_norm(positions[after] - positions[before]);
      const bool is_taken = taken.has(before, after);
      if (is_taken < ear_taken || (is_taken == ear_taken && length < shortest)) {
        shortest = length;
        ear = i;
        ear_taken = is_taken;
      }
    }
    const std::uint32_t before = polygon[(ear + n - 1) % n], after = polygon[(ear + 1) % n];
    taken.add(before, after);
    *triangles++ = {before, polygon[ear], after};
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  *triangles = {polygon[0], polygon[1], polygon[2]};
}

void add_repeated(const Polygon& polygon, Defects& defects) {
  for (std::size_t i = 0; i < polygon.size(); ++i)
    for (std::size_t j = i + 1; j < polygon.size(); ++j)
      if (polygon[i] == polygon[j]) defects.push_back({polygon[i], polygon[i]});
}

/// Σ list(p), p in order.
template <typename Item, typename List>
std::vector<Item> joined(std::size_t count, const ExecutionContext& context, const List& list) {
  std::vector<std::size_t> start(count + 1, 0);
  for (std::size_t p = 0; p < count; ++p) start[p + 1] = start[p] + list(p).size();
  std::vector<Item> all(start.back());
  parallel_tasks(context, count, [&](std::size_t p) {
    std::copy(list(p).begin(), list(p).end(), all.begin() + static_cast<std::ptrdiff_t>(start[p]));
  });
  return all;
}

/// What find(i, list) puts into lists, for i in [0, count), in order.
template <typename Find>
Defects found_in_parallel(std::size_t count, const ExecutionContext& context, const Find& find) {
  constexpr std::size_t piece = 8192;
  std::vector<Defects> of_piece((count + piece - 1) / piece);
  parallel_tasks(context, of_piece.size(), [&](std::size_t p) {
    for (std::size_t i = p * piece; i < std::min(count, (p + 1) * piece); ++i) find(i, of_piece[p]);
  });
  return joined<Pair>(of_piece.size(), context, [&](std::size_t p) -> const Defects& { return of_piece[p]; });
}

}  // namespace

DualMesh triangulate_polygons(const std::vector<std::vector<std::uint32_t>>& polygons,
                              std::span<const std::uint32_t> labels, std::span<const Vec3> positions, bool open,
                              const ExecutionContext& context) {
  constexpr std::size_t piece = 512;
  std::vector<Part> parts((polygons.size() + piece - 1) / piece);
  parallel_tasks(context, parts.size(), [&](std::size_t p) {
    const std::size_t begin = p * piece, count = std::min(piece, polygons.size() - begin);
    parts[p] = Part(std::span(polygons).subspan(begin, count), labels);
    parts[p].make_triangles();
  });
  DualMesh mesh;
  TakenEdges taken(parts, positions.size(), context);
  for (Part& part : parts)
    for (Odd& odd : part.odd) {
      if (odd.repeated)
        add_repeated(odd.corners, mesh.defects);
      else
        cut_ears(odd.corners, positions, taken, &part.triangles[odd.triangle]);
    }
  mesh.triangles = joined<Triangle>(parts.size(), context,
                                    [&](std::size_t p) -> const std::vector<Triangle>& { return parts[p].triangles; });
  const auto bad = manifold_defects(mesh.triangles, positions.size(), open, context);
  mesh.defects.insert(mesh.defects.end(), bad.begin(), bad.end());
  return mesh;
}

std::size_t remove_two_triangle_spheres(std::vector<Triangle>& triangles, std::size_t vertices) {
  std::vector<std::uint32_t> used(vertices, 0);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) ++used[v];
  // Two triangles at each corner of a closed surface are the two sides of a pillow.
  const std::size_t removed = std::erase_if(
      triangles, [&](const Triangle& t) { return used[t[0]] == 2 && used[t[1]] == 2 && used[t[2]] == 2; });
  return removed / 2;
}

Defects manifold_defects(std::span<const Triangle> triangles, std::size_t vertices, bool open,
                         const ExecutionContext& context) {
  const HalfEdges edges(triangles, vertices, context);
  Defects bad = found_in_parallel(3 * triangles.size(), context, [&](std::size_t h, Defects& list) {
    if (edges.opposite(h) == HalfEdges::none)
      list.push_back(ordered(triangles[h / 3][h % 3], triangles[h / 3][(h % 3 + 1) % 3]));
  });
  if (open) {  // an edge of one triangle is boundary; those that come several times are not
    std::sort(bad.begin(), bad.end());
    Defects repeated;
    for (std::size_t i = 1; i < bad.size(); ++i)
      if (bad[i] == bad[i - 1]) repeated.push_back(bad[i]);
    return repeated;
  }
  if (!bad.empty()) return bad;
  return found_in_parallel(vertices, context, [&](std::size_t v, Defects& list) {
    if (edges.umbrellas(v) > 1) list.push_back({static_cast<std::uint32_t>(v), static_cast<std::uint32_t>(v)});
  });
}

}  // namespace evenmesh
