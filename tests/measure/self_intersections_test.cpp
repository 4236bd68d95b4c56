#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.h"
#include "evenmesh/measure.h"
#include "geometry/primitives.h"

namespace evenmesh {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
using Int = std::int64_t;
using IntVec = std::array<Int, 3>;

IntVec minus(const IntVec& a, const IntVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
IntVec times(const IntVec& a, const IntVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Int dot_of(const IntVec& a, const IntVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Whether the convex hulls of two small sets of points (a triangle and a triangle or a segment) meet: no axis
/// separates them strictly. The axes are the facet normals of their Minkowski difference, flat cases included.
bool hulls_meet(const std::vector<IntVec>& s, const std::vector<IntVec>& t) {
  std::vector<IntVec> edges_s, edges_t, axes;
  for (std::size_t i = 0; i < s.size(); ++i) edges_s.push_back(minus(s[(i + 1) % s.size()], s[i]));
  for (std::size_t i = 0; i < t.size(); ++i) edges_t.push_back(minus(t[(i + 1) % t.size()], t[i]));
  for (const IntVec& e : edges_s)
    for (const IntVec& f : edges_t) axes.push_back(times(e, f));
  for (const auto* edges : {&edges_s, &edges_t}) {
    if (edges->size() < 3) continue;
    const IntVec normal = times((*edges)[0], (*edges)[1]);
    axes.push_back(normal);
    for (const IntVec& e : edges_s) axes.push_back(times(normal, e));
    for (const IntVec& e : edges_t) axes.push_back(times(normal, e));
  }
  for (const IntVec& axis : axes) {
    Int s_lo = dot_of(axis, s[0]), s_hi = s_lo, t_lo = dot_of(axis, t[0]), t_hi = t_lo;
    for (const IntVec& p : s) s_lo = std::min(s_lo, dot_of(axis, p)), s_hi = std::max(s_hi, dot_of(axis, p));
    for (const IntVec& p : t) t_lo = std::min(t_lo, dot_of(axis, p)), t_hi = std::max(t_hi, dot_of(axis, p));
    if (s_hi < t_lo || t_hi < s_lo) return false;
  }
  return true;
}

struct Soup {
  std::vector<IntVec> points;
  std::vector<Triangle> triangles;

  Mesh mesh(double scale, const Vec3& offset) const {
    Mesh m;
    for (const IntVec& p : points)
      m.vertices.push_back(offset + scale * Vec3{double(p[0]), double(p[1]), double(p[2])});
    m.triangles = triangles;
    return m;
  }
  bool degenerate(const Triangle& t) const {
    return times(minus(points[t[1]], points[t[0]]), minus(points[t[2]], points[t[0]])) == IntVec{0, 0, 0};
  }
  std::vector<IntVec> corners(const Triangle& t) const { return {points[t[0]], points[t[1]], points[t[2]]}; }
  std::vector<IntVec> without(const Triangle& t, const std::vector<std::uint32_t>& shared) const {
    std::vector<IntVec> rest;
    for (const std::uint32_t v : t)
      if (std::find(shared.begin(), shared.end(), v) == shared.end()) rest.push_back(points[v]);
    return rest;
  }

  bool overlap(const Triangle& s, const Triangle& t) const {
    std::vector<std::uint32_t> shared;
    for (const std::uint32_t v : s)
      if (std::find(t.begin(), t.end(), v) != t.end()) shared.push_back(v);
    if (shared.empty()) return hulls_meet(corners(s), corners(t));
    if (shared.size() == 1)
      return hulls_meet(without(s, shared), corners(t)) || hulls_meet(without(t, shared), corners(s));
    if (shared.size() == 3) return true;
    const IntVec edge = minus(points[shared[1]], points[shared[0]]);
    const IntVec to_r = minus(without(s, shared)[0], points[shared[0]]),
                 to_w = minus(without(t, shared)[0], points[shared[0]]);
    const IntVec r_normal = times(edge, to_r), w_normal = times(edge, to_w);
    return dot_of(r_normal, to_w) == 0 && dot_of(r_normal, w_normal) > 0;
  }

  Pairs by_brute_force() const {
    Pairs pairs;
    for (std::uint32_t s = 0; s < triangles.size(); ++s)
      for (std::uint32_t t = s + 1; t < triangles.size(); ++t)
        if (!degenerate(triangles[s]) && !degenerate(triangles[t]) && overlap(triangles[s], triangles[t]))
          pairs.emplace_back(s, t);
    return pairs;
  }
};

Soup random_soup(std::uint64_t seed, std::size_t points, std::size_t triangles, Int size, Int height) {
  Random random(seed);
  Soup soup;
  const auto coordinate = [&](Int limit) { return static_cast<Int>(random.below(static_cast<std::uint64_t>(limit))); };
  for (std::size_t i = 0; i < points; ++i) {
    const Int x = coordinate(size), y = coordinate(size), z = coordinate(height);
    soup.points.push_back({x, y, z});
  }
  while (soup.triangles.size() < triangles) {
    const auto pick = [&] { return static_cast<std::uint32_t>(random.below(points)); };
    const std::uint32_t a = pick(), b = pick(), c = pick();
    soup.triangles.push_back({a, b, c});
  }
  return soup;
}

TEST(SelfIntersections, AgreeWithExactBruteForceOnSoups) {
  // Few points on a small lattice: shared vertices and edges, coplanar, collinear and coincident cases abound.
  const struct {
    std::size_t points, triangles;
    Int size, height;
  } kinds[] = {{12, 30, 4, 4}, {20, 40, 5, 1}, {30, 40, 6, 2}, {150, 60, 12, 12}, {150, 50, 1000, 1000}};
  for (const auto& k : kinds)
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      const Soup soup = random_soup(seed, k.points, k.triangles, k.size, k.height);
      const Pairs expected = soup.by_brute_force();
      EXPECT_EQ(self_intersections(soup.mesh(1, {})), expected) << "seed " << seed << ", " << k.points << " points";
      EXPECT_EQ(self_intersections(soup.mesh(0x1p-20, {1 << 20, 3, -(1 << 19)})), expected);
    }
}

std::size_t count_in(std::vector<Vec3> vertices, std::vector<Triangle> triangles) {
  return self_intersections(Mesh{std::move(vertices), std::move(triangles)}).size();
}

TEST(SelfIntersections, FindCrossingAndTouchingTriangles) {
  const Vec3 a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
  const std::vector<Triangle> apart = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(count_in({a, b, c, {1, 1, -1}, {1, 1, 1}, {9, 9, 1}}, apart), 1u) << "crossing";
  EXPECT_EQ(count_in({a, b, c, {1, 1, 0}, {1, 1, 1}, {2, 1, 1}}, apart), 1u) << "touching at a point of the face";
  EXPECT_EQ(count_in({a, b, c, {0, 0, 0}, {-1, 0, 1}, {-1, 0, -1}}, apart), 1u) << "touching at a corner";
  EXPECT_EQ(count_in({a, b, c, {1, 1, 1e-60}, {1, 1, 1}, {2, 1, 1}}, apart), 0u) << "just above";
  EXPECT_EQ(count_in({a, b, c, {1, 1, 0}, {9, 1, 0}, {9, 9, 0}}, apart), 1u) << "coplanar overlap";
  EXPECT_EQ(count_in({a, b, c, {0.5, 0.5, 0}, {1, 0.5, 0}, {0.5, 1, 0}}, apart), 1u)
      << "coplanar, one within the other";
  EXPECT_EQ(count_in({a, b, c, {4, 4, 0}, {5, 4, 0}, {4, 5, 0}}, apart), 0u) << "coplanar, apart";
  EXPECT_EQ(count_in({a, b, c, {2, 2, 0}, {5, 4, 0}, {4, 5, 0}}, apart), 1u) << "coplanar, corner on an edge";
}

TEST(SelfIntersections, KnowNeighbours) {
  const Vec3 a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
  const std::vector<Triangle> vertex = {{0, 1, 2}, {0, 3, 4}}, edge = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(count_in({a, b, c, {-1, 0, 0}, {0, -1, 0}}, vertex), 0u) << "opposite corners of one plane";
  EXPECT_EQ(count_in({a, b, c, {1, 1, 1}, {1, 1, -1}}, vertex), 1u) << "piercing beyond the shared vertex";
  EXPECT_EQ(count_in({a, b, c, {1, 1, 1}, {1, 2, 1}}, vertex), 0u) << "above";
  EXPECT_EQ(count_in({a, b, c, {9, 0, 0}, {0, -1, 0}}, vertex), 1u) << "edges overlap along a line";
  EXPECT_EQ(count_in({a, b, c, {1, 1, 0}, {-1, -1, 1}}, vertex), 1u) << "an edge runs in the face";
  EXPECT_EQ(count_in({a, b, c, {0, -1, 0}}, edge), 0u) << "flat";
  EXPECT_EQ(count_in({a, b, c, {1, 3, 1}}, edge), 0u) << "sharp fold, still open";
  EXPECT_EQ(count_in({a, b, c, {1, 3, 0}}, edge), 1u) << "folded onto each other";
  EXPECT_EQ(count_in({a, b, c}, {{0, 1, 2}, {2, 1, 0}}), 1u) << "the same triangle twice";
  EXPECT_EQ(count_in({a, b, c, {1, 1, -1}, {1, 1, 1}}, {{0, 1, 2}, {3, 4, 4}}), 0u) << "degenerate ones are left out";
}

TEST(SelfIntersections, OfTrianglesThatShareAnEdgeOfMoreThanTwo) {
  const Vec3 a{0, 0, 0}, b{4, 0, 0};
  const std::vector<Triangle> three = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
  EXPECT_EQ(count_in({a, b, {2, 3, 0}, {2, -3, 0}, {2, 0, 3}}, three), 0u) << "a fin on a flat sheet";
  EXPECT_EQ(count_in({a, b, {2, 3, 0}, {2, 3, 1}, {2, 3, 2}}, three), 0u) << "pages of a book";
  EXPECT_EQ(count_in({a, b, {2, 3, 0}, {1, 2, 0}, {2, 0, 3}}, three), 1u) << "two of them folded onto each other";
  EXPECT_EQ(count_in({a, b, {2, 3, 0}, {1, 2, 0}, {3, 1, 0}}, three), 3u) << "all folded onto each other";
  EXPECT_EQ(
      count_in({a, b, {2, 3, 0}, {2, -3, 0}, {2, 0, 3}, {2, 0, -3}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 1, 5}}), 0u)
      << "two sheets cross in an edge of both";
}

TEST(SelfIntersections, CountTheSameTriangleOncePerPair) {
  const std::vector<Vec3> corners = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  EXPECT_EQ(count_in(corners, {{0, 1, 2}, {0, 1, 2}}), 1u);
  EXPECT_EQ(count_in(corners, {{0, 1, 2}, {1, 2, 0}, {2, 1, 0}}), 3u) << "whichever way round";
  std::vector<Vec3> twice = corners;
  twice.insert(twice.end(), corners.begin(), corners.end());
  EXPECT_EQ(count_in(twice, {{0, 1, 2}, {3, 4, 5}}), 1u) << "in the same place";
  EXPECT_EQ(count_in(twice, {{0, 1, 2}, {0, 4, 5}}), 1u) << "in the same place, one vertex in common";
  EXPECT_EQ(count_in(twice, {{0, 1, 2}, {0, 1, 5}}), 1u) << "in the same place, an edge in common";
}

TEST(SelfIntersections, OfSolidsThatShareAVertexOrAnEdge) {
  const Mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const auto with_another = [&](std::vector<Vec3> more, const Triangle& last, std::uint32_t first) {
    Mesh mesh = tetrahedron;
    mesh.vertices.insert(mesh.vertices.end(), more.begin(), more.end());
    const auto [b, c, d] = last;
    for (const Triangle& t : {Triangle{first, c, b}, {first, b, d}, {first, d, c}, {b, c, d}})
      mesh.triangles.push_back(t);
    return self_intersections(mesh).size();
  };
  EXPECT_EQ(with_another({{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {4, 5, 6}, 0), 0u) << "tip to tip";
  EXPECT_EQ(with_another({{0.5, 0.5, 0.6}, {0.5, 0.6, 0.5}, {0.6, 0.5, 0.5}}, {4, 5, 6}, 0), 1u * 3)
      << "tip through a face";
  EXPECT_EQ(with_another({{0, -1, 0}, {0, 0, -1}}, {1, 4, 5}, 0), 0u) << "edge to edge";
  EXPECT_EQ(with_another({{0.1, 0.1, -1}, {0.1, -1, 0.1}}, {1, 4, 5}, 0), 0u) << "edge to edge, turned";
}

TEST(SelfIntersections, OfNothingButDegenerateTrianglesAreNone) {
  EXPECT_EQ(count_in({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {0, 1, 2}, {0, 0, 1}, {2, 2, 2}}), 0u);
  EXPECT_EQ(count_in({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 1}, {0, 1, 0}}), 0u);
}

TEST(SelfIntersections, CleanMeshesHaveNone) {
  for (const Mesh& mesh : {make_icosphere(4), make_torus(), make_box({1, 1, 1}, 12), make_grid_plane(20, 20, 0.1)})
    EXPECT_TRUE(self_intersections(mesh).empty());
  EXPECT_TRUE(self_intersections(Mesh{}).empty());
}

TEST(SelfIntersections, AreTheSameForAnyNumberOfThreads) {
  const Mesh mesh = merged(make_icosphere(4), translated(make_icosphere(4), {0.7, 0.1, 0.2}));
  evenmesh::ExecutionContext one(1), three(3);
  const Pairs pairs = self_intersections(mesh, one);
  EXPECT_FALSE(pairs.empty());
  EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
  EXPECT_EQ(pairs, self_intersections(mesh, three));
  for (const auto& [s, t] : pairs) EXPECT_LT(s, t);
}

TEST(SelfIntersections, HonourCancel) {
  evenmesh::ExecutionContext context;
  context.cancel();
  EXPECT_THROW(self_intersections(make_icosphere(3), context), Cancelled);
}

}  // namespace
}  // namespace evenmesh
