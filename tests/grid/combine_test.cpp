#include "grid/combine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "evenmesh/solid.h"
#include "geometry/half_edges.h"
#include "geometry/primitives.h"
#include "grid/dual_surface.h"
#include "grid/inside_runs.h"
#include "sample/distance_field.h"
#include "sample/sample.h"
#include "sample_checks.h"

namespace evenmesh {
namespace {

const Box space{{-1.6, -1.6, -1.6}, {1.6, 1.6, 1.6}};

SampleSet on_grid(const Shape& shape, std::size_t resolution = 60, unsigned threads = 2) {
  evenmesh::ExecutionContext context(threads);
  return sample_shape(shape, make_grid(space, resolution), context);
}
Shape ball(const Vec3& at, double radius) {
  return transformed(gallery_shape("sphere"), Affine::translate(at).after(Affine::scale({radius, radius, radius})));
}
Shape everything() {
  return shape_from_box(space);
}

bool same(const SampleSet& a, const SampleSet& b) {
  if (a.size() != b.size() || a.blocks.size() != b.blocks.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a.x[i] != b.x[i] || a.y[i] != b.y[i] || a.z[i] != b.z[i] || a.area[i] != b.area[i] ||
        a.normal[i].bits != b.normal[i].bits || a.edge[i].bits != b.edge[i].bits)
      return false;
  for (std::size_t i = 0; i < a.blocks.size(); ++i)
    if (a.blocks[i].brick != b.blocks[i].brick || a.blocks[i].begin != b.blocks[i].begin) return false;
  return true;
}

struct Operands {
  SampleSet a = on_grid(ball({-0.2, 0.1, 0}, 0.9)), b = on_grid(gallery_shape("torus")),
            c = on_grid(shape_from_mesh(make_box({0.7, 0.9, 0.3})));
};

TEST(Combine, InsideIsTheBooleanOfInsides) {
  const Operands o;
  evenmesh::ExecutionContext context(2);
  const InsideRuns a(o.a, context), b(o.b, context);
  for (const Boolean operation : {Boolean::unite, Boolean::intersect, Boolean::subtract}) {
    const SampleSet set = combine(o.a, o.b, operation, context);
    const InsideRuns result(set, context);
    const auto size = set.grid.size;
    std::size_t crossings = 0;
    const auto expected = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      const bool in_a = a(i, j, k), in_b = b(i, j, k);
      return operation == Boolean::unite       ? in_a || in_b
             : operation == Boolean::intersect ? in_a && in_b
                                               : in_a && !in_b;
    };
    for (std::int32_t k = 0; k < std::int32_t(size[2]); ++k)
      for (std::int32_t j = 0; j < std::int32_t(size[1]); ++j)
        for (std::int32_t i = 0; i < std::int32_t(size[0]); ++i) {
          const bool inside = expected(i, j, k);
          ASSERT_EQ(result(i, j, k), inside);
          crossings +=
              (inside != expected(i + 1, j, k)) + (inside != expected(i, j + 1, k)) + (inside != expected(i, j, k + 1));
        }
    EXPECT_EQ(set.size(), crossings) << "all three directions have the same inside";
  }
}

TEST(Combine, IdempotenceAndDeMorganBitForBit) {
  const Operands o;
  evenmesh::ExecutionContext context(2);
  for (const SampleSet* s : {&o.a, &o.b, &o.c}) {
    EXPECT_TRUE(same(combine(*s, *s, Boolean::unite, context), *s));
    EXPECT_TRUE(same(combine(*s, *s, Boolean::intersect, context), *s));
    EXPECT_EQ(combine(*s, *s, Boolean::subtract, context).size(), 0u);
  }
  const SampleSet all = on_grid(everything());
  const auto without = [&](const SampleSet& s) { return combine(all, s, Boolean::subtract, context); };
  EXPECT_TRUE(same(without(combine(o.a, o.b, Boolean::unite, context)),
                   combine(without(o.a), without(o.b), Boolean::intersect, context)));
  EXPECT_TRUE(same(without(combine(o.a, o.b, Boolean::intersect, context)),
                   combine(without(o.a), without(o.b), Boolean::unite, context)));
  EXPECT_TRUE(same(combine(combine(o.a, o.b, Boolean::subtract, context), o.c, Boolean::subtract, context),
                   combine(o.a, combine(o.b, o.c, Boolean::unite, context), Boolean::subtract, context)));
  EXPECT_TRUE(same(combine(o.a, o.b, Boolean::unite, context), combine(o.b, o.a, Boolean::unite, context)));
}

TEST(Combine, SameForAnyNumberOfThreads) {
  const Shape shape = subtract(unite({ball({0, 0, 0}, 1), gallery_shape("torus")}), {ball({0.5, 0, 0.5}, 0.6)});
  EXPECT_TRUE(same(on_grid(shape, 50, 1), on_grid(shape, 50, 7)));
  EXPECT_TRUE(same(on_grid(offset(shape, 0.1), 50, 1), on_grid(offset(shape, 0.1), 50, 7)));
}

double volume_of(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) / 6;
  return sum;
}
bool closed(const Mesh& mesh) {
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  for (std::size_t h = 0; h < 3 * mesh.triangles.size(); ++h)
    if (edges.opposite(h) == HalfEdges::none) return false;
  return true;
}

TEST(DualSurface, IsClosedAndKeepsEdges) {
  evenmesh::ExecutionContext context(2);
  const Box box{{-0.71, -0.52, -0.33}, {0.8, 0.6, 0.4}};
  const Mesh mesh = dual_surface(on_grid(shape_from_box(box)), context);
  EXPECT_TRUE(closed(mesh));
  const Vec3 size = box.size();
  EXPECT_NEAR(volume_of(mesh), size.x * size.y * size.z, 2e-3);
  const Box found = mesh.bounds();
  EXPECT_LT(norm(found.lo - box.lo) + norm(found.hi - box.hi), 4e-3);
  const Mesh torus = dual_surface(on_grid(gallery_shape("torus")), context);
  EXPECT_TRUE(closed(torus));
  EXPECT_NEAR(volume_of(torus), 2 * std::numbers::pi * std::numbers::pi * 0.35 * 0.35, 5e-3);
}

TEST(Combine, VolumesAddUp) {
  evenmesh::ExecutionContext context(2);
  const Shape a = ball({-0.2, 0.1, 0}, 0.9), b = gallery_shape("torus");
  const auto volume = [&](const Shape& shape) { return volume_of(dual_surface(on_grid(shape, 512), context)); };
  const double sum = volume(a) + volume(b);
  EXPECT_NEAR(volume(unite({a, b})) + volume(intersect({a, b})), sum, 0.002 * sum);
}

/// The farthest that any sample lies from where it should, in cells.
template <typename Distance>
double worst(const SampleSet& set, const Distance& distance) {
  double largest = 0;
  for (const SampleBlock& block : set.blocks)
    for (std::uint32_t s = block.begin; s < block.end; ++s)
      largest = std::max(largest, std::abs(distance(set.block_center(block) + Vec3{set.x[s], set.y[s], set.z[s]})));
  return largest / set.grid.spacing;
}

TEST(Offset, LiesWithinACellOfTheExactOne) {
  const auto ball_distance = [](const Vec3& p) { return norm(p) - 1; };
  const auto torus_distance = [](const Vec3& p) { return std::hypot(std::hypot(p.x, p.y) - 1, p.z) - 0.35; };
  const auto box_distance = [](const Vec3& p) {
    Vec3 out;
    double in = -1e9;
    for (int a = 0; a < 3; ++a) out[a] = std::max(0.0, std::abs(p[a]) - 0.8), in = std::max(in, std::abs(p[a]) - 0.8);
    return in < 0 ? in : norm(out);
  };
  const Shape box = shape_from_mesh(make_box({0.8, 0.8, 0.8}));
  for (const double d : {0.02, 0.07, 0.2, -0.02, -0.07, -0.2}) {
    SCOPED_TRACE(d);
    for (const std::size_t resolution : {40u, 100u}) {
      EXPECT_LT(worst(on_grid(offset(gallery_shape("sphere"), d), resolution),
                      [&](const Vec3& p) { return ball_distance(p) - d; }),
                0.5);
      EXPECT_LT(worst(on_grid(offset(gallery_shape("torus"), d), resolution),
                      [&](const Vec3& p) { return torus_distance(p) - d; }),
                0.5);
      EXPECT_LT(worst(on_grid(offset(box, d), resolution), [&](const Vec3& p) { return box_distance(p) - d; }), 1.0);
    }
  }
}

TEST(Offset, ClosesAndOpens) {
  // Two balls a gap apart become one, and a thin handle goes.
  const Shape two = unite({ball({-0.55, 0, 0}, 0.5), ball({0.55, 0, 0}, 0.5)});
  evenmesh::ExecutionContext context(2);
  const auto volume = [&](const Shape& shape) { return volume_of(dual_surface(on_grid(shape, 100), context)); };
  EXPECT_GT(volume(closing(two, 0.2)), volume(two) + 0.001);
  const Shape ball_with_rod = unite({ball({0, 0, 0}, 0.6), shape_from_box({{0, -0.05, -0.05}, {1.3, 0.05, 0.05}})});
  EXPECT_NEAR(volume(opening(ball_with_rod, 0.15)), volume(ball({0, 0, 0}, 0.6)), 0.01);
}

TEST(Solid, TransformsFollowTheTree) {
  const Affine move =
      Affine::translate({0.2, 0.1, -0.1}).after(Affine::rotate({1, 2, 3}, 50).after(Affine::scale({0.5, 0.5, 0.5})));
  const Shape tree = subtract(offset(gallery_shape("cube"), 0.1), {ball({0.5, 0.5, 0.5}, 0.8)});
  evenmesh::ExecutionContext context(2);
  const Box whole{{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}};
  const double before = volume_of(dual_surface(sample_shape(tree, make_grid(whole, 120), context), context));
  const double after =
      volume_of(dual_surface(sample_shape(transformed(tree, move), make_grid(whole, 240), context), context));
  EXPECT_NEAR(after, before / 8, 0.01 * before / 8);
  EXPECT_THROW(transformed(tree, Affine::scale({1, 2, 1})), InvalidInput);
  EXPECT_THROW(transformed(tree, Affine::scale({1, 0, 1})), InvalidInput);
  const Vec3 p{1, 2, 3};
  EXPECT_LT(norm(move.inverse()(move(p)) - p), 1e-12);
}

}  // namespace
}  // namespace evenmesh
