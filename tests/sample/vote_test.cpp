#include <gtest/gtest.h>

#include <functional>

#include "core/random.h"
#include "geometry/primitives.h"
#include "grid/sample_checks.h"

namespace evenmesh {
namespace {

Mesh without(Mesh mesh, const std::function<bool(const Vec3&)>& removed) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return removed((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  });
  return mesh;
}

void expect_resolved(const SampleSet& set, const Mesh& mesh) {
  expect_well_formed(set);
  expect_one_sign_grid(set);
  for (const std::uint32_t source : set.source) EXPECT_LT(source, mesh.triangles.size());
}

TEST(Vote, SmallHolesAreClosed) {
  const Mesh ball = make_icosphere(4);
  const Mesh holey = without(ball, [](const Vec3& c) { return c.z > 0.97 || (c.x > 0.6 && c.y > 0.7); });
  ASSERT_LT(holey.triangles.size(), ball.triangles.size());
  const SampleSet whole = sampled(ball, 80), set = sampled(holey, 80);
  expect_resolved(set, holey);
  EXPECT_GT(set.disagreements, 0u);
  const double volume = volume_of(whole, expect_one_sign_grid(whole));
  EXPECT_NEAR(volume_of(set, expect_one_sign_grid(set)), volume, 0.03 * volume);
}

TEST(Vote, TubeWithoutLidsIsASolid) {
  // The side of a box without top and bottom: two directions see the inside, the third sees nothing.
  const Mesh tube = without(make_box({1, 1, 1}, 8), [](const Vec3& c) { return std::abs(c.z) > 0.99; });
  const SampleSet set = sampled(tube, 40);
  expect_resolved(set, tube);
  EXPECT_NEAR(volume_of(set, expect_one_sign_grid(set)), 8, 0.8);
  EXPECT_GT(set.disagreements, 1000u);
}

TEST(Vote, InconsistentOrientationIsRead) {
  Mesh mesh = make_icosphere(3);
  Random random(7);
  for (Triangle& t : mesh.triangles)
    if (random.below(2) == 0) std::swap(t[0], t[1]);
  const SampleSet set = sampled(mesh, 60);
  expect_resolved(set, mesh);
}

TEST(Vote, SoupsStillGiveASolid) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random random(seed);
    Mesh soup;
    for (std::uint32_t i = 0; i < 120; ++i) {
      for (int c = 0; c < 3; ++c) soup.vertices.push_back({random.uniform(), random.uniform(), random.uniform()});
      soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const SampleSet set = sampled(soup, 50, 1);
    expect_resolved(set, soup);
    EXPECT_GT(set.disagreements, 0u);
    expect_same(set, sampled(soup, 50, 2));
  }
}

TEST(Vote, LargerThanOneWordAndOneTask) {
  const Mesh ball = without(make_icosphere(4), [](const Vec3& c) { return c.x > 0.95 || c.z < -0.9; });
  const SampleSet set = sampled(ball, 150);
  expect_resolved(set, ball);
  expect_same(set, sampled(ball, 150, 2));
}

TEST(Vote, CoveredSheetsHaveNoInside) {
  const Mesh sheet = make_grid_plane(4, 4);
  Shape shape = solid_of(sheet);
  EXPECT_THROW(sample_shape(shape, make_grid(shape.bounds, 20)), Error);
}

}  // namespace
}  // namespace evenmesh
