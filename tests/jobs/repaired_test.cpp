#include "evenmesh/repaired.h"

#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>
#include <vector>

#include "evenmesh/error.h"
#include "geometry/primitives.h"

namespace evenmesh {
namespace {

Shape ball(int subdivisions = 3) {
  return shape_from_mesh(make_icosphere(subdivisions), "ball");
}

/// Its triangles in one hemisphere.
Shape bowl() {
  Mesh mesh = make_icosphere(4);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.vertices[t[0]].z + mesh.vertices[t[1]].z + mesh.vertices[t[2]].z > 0;
  });
  return shape_from_mesh(std::move(mesh), "bowl");
}

Shape damaged_ball() {
  Mesh mesh = make_icosphere(3);
  mesh.triangles.push_back(mesh.triangles[0]);  // once more
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  mesh.triangles.erase(mesh.triangles.begin() + 100);
  return shape_from_mesh(std::move(mesh), "damaged");
}

TEST(Repaired, ASolidBecomesItsOuterHull) {
  const Repaired r = repaired(ball());
  EXPECT_EQ(r.options.method, Method::raster);
  EXPECT_TRUE(r.options.fill_cavities);
  EXPECT_FALSE(r.options.wrap);
  EXPECT_EQ(r.solidity, 1);
  EXPECT_FALSE(r.wrapped_sheets);
  EXPECT_EQ(summary_of(r.defects), "no defects of connection");
  EXPECT_EQ(r.shape.name, "ball");
}

TEST(Repaired, KeepsTheUnitAndWhatWasSaid) {
  Shape shape = damaged_ball();
  shape.unit = LengthUnit::inch;
  shape.findings.push_back(make_finding(FindingCode::no_area, {{"count", 1.0}, {"where", std::string()}}));
  for (const Hull hull : {Hull::outer, Hull::wrap}) {
    const Repaired r = repaired(shape, hull);
    EXPECT_EQ(r.shape.unit, LengthUnit::inch);
    EXPECT_EQ(r.shape.findings.size(), 1u);
  }
}

TEST(Repaired, SheetsAreWrapped) {
  const Repaired r = repaired(bowl());
  EXPECT_TRUE(r.wrapped_sheets);
  EXPECT_LT(r.solidity.value(), 0.6);
  EXPECT_TRUE(r.options.wrap);
  EXPECT_EQ(r.options.method, Method::shell);
  EXPECT_EQ(r.filled_holes, 0u);
  const Repaired outer = repaired(bowl(), Hull::outer);
  EXPECT_FALSE(outer.options.wrap);
  EXPECT_EQ(outer.solidity, std::nullopt) << "nobody asked";
}

TEST(Repaired, TellsWhatItDid) {
  const Repaired r = repaired(damaged_ball());
  EXPECT_EQ(r.defects.repeated_triangles, 1u);
  EXPECT_EQ(r.defects.turned_triangles, 1u);
  EXPECT_EQ(r.filled_holes, 1u);
  EXPECT_EQ(summary_of(r.defects), "1 repeated triangles left out, 1 triangles turned, 3 boundary edges");
  const MeshResult result = mesh_shape(r.shape, r.options);
  EXPECT_TRUE(result.report.quality.closed());
  EXPECT_TRUE(result.report.quality.two_manifold());
}

TEST(Repaired, HolesAreFilledBeforeSolidityIsJudged) {
  Mesh cube = make_box();
  cube.triangles.pop_back();
  const Repaired r = repaired(shape_from_mesh(std::move(cube), "cube"));
  EXPECT_EQ(r.filled_holes, 1u);
  ASSERT_TRUE(r.largest_hole);
  EXPECT_NEAR(r.largest_hole->size, std::sqrt(8.0), 1e-9);
  EXPECT_FALSE(r.wrapped_sheets);
  EXPECT_EQ(r.solidity, 1);
  const MeshResult result = mesh_shape(r.shape, r.options);
  EXPECT_NEAR(result.report.quality.volume, 8, 0.01);
}

TEST(Repaired, SheetsBesideASolidAreLeftToBeNamed) {
  Mesh sheet = make_grid_plane(1, 1);
  const Repaired r = repaired(shape_from_mesh(merged(make_box(), translated(std::move(sheet), {0, 0, 2})), "both"));
  EXPECT_FALSE(r.wrapped_sheets);
  EXPECT_EQ(r.filled_holes, 0u) << "a sheet has no hole";
  MeshOptions options = r.options;
  options.vertices = 400;
  const MeshResult result = mesh_shape(r.shape, options);
  EXPECT_NEAR(result.report.quality.volume, 8, 0.01);
  EXPECT_TRUE(std::any_of(result.report.findings.begin(), result.report.findings.end(),
                          [](const Finding& f) { return f.code == FindingCode::sheets_left_out; }));
}

TEST(Repaired, TheHullDecidesAndOtherOptionsStay) {
  const MeshOptions given{.vertices = 77, .seed = 5};
  const auto hull = [&](Hull h) { return repaired(ball(), h, given); };
  EXPECT_TRUE(hull(Hull::outer).options.fill_cavities);
  EXPECT_FALSE(hull(Hull::all).options.fill_cavities);
  EXPECT_EQ(hull(Hull::oriented).shape.winding, Winding::positive);
  EXPECT_EQ(hull(Hull::outer).shape.winding, Winding::any);
  EXPECT_TRUE(hull(Hull::wrap).options.wrap);
  EXPECT_FALSE(hull(Hull::wrap).wrapped_sheets) << "asked for, not found";
  EXPECT_EQ(hull(Hull::all).options.vertices, 77u);
  EXPECT_EQ(hull(Hull::all).options.seed, 5u);
}

TEST(Repaired, TakesMeshesWithAnAreaOnly) {
  EXPECT_THROW(repaired(gallery_shape("sphere")), InvalidInput);
  Mesh flat{.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, .triangles = {{0, 1, 2}}};
  EXPECT_THROW(repaired(shape_from_mesh(std::move(flat))), UnusableInput);
}

TEST(Repaired, StopsWhenCancelled) {
  ExecutionContext context;
  context.cancel();
  EXPECT_THROW(repaired(ball(), Hull::automatic, {}, context), Cancelled);
  EXPECT_THROW(solidity(make_icosphere(3), context), Cancelled) << "in the middle, too";
}

TEST(Repaired, StopsOnItsWay) {
  const Shape shape = ball(7);
  ExecutionContext context;
  std::thread impatient([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    context.cancel();
  });
  EXPECT_THROW(repaired(shape, Hull::automatic, {}, context), Cancelled);
  impatient.join();
}

double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Processor time that other threads of this process spend meanwhile.
double seconds_of_others(ExecutionContext& context, const Shape& shape) {
  const double all = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  const double own = seconds_of(CLOCK_THREAD_CPUTIME_ID);
  repaired(shape, Hull::automatic, {}, context);
  const double of_this_thread = seconds_of(CLOCK_THREAD_CPUTIME_ID) - own;
  return seconds_of(CLOCK_PROCESS_CPUTIME_ID) - all - of_this_thread;
}

TEST(Repaired, OneThreadIsOneThread) {
  const Shape shape = ball(7);  // 330,000 triangles: with two threads the other one has 4 ms to do
  ExecutionContext one(1);
  // Twice, for threads of earlier tests may still be on their way to sleep.
  EXPECT_LT(std::min(seconds_of_others(one, shape), seconds_of_others(one, shape)), 0.001);
}

TEST(Repaired, IsTheSameForAnyNumberOfThreads) {
  ExecutionContext one(1), many(0);
  const Repaired a = repaired(damaged_ball(), Hull::automatic, {}, one);
  const Repaired b = repaired(damaged_ball(), Hull::automatic, {}, many);
  EXPECT_EQ(a.solidity, b.solidity);
  EXPECT_EQ(a.shape.mesh()->vertices, b.shape.mesh()->vertices);
  EXPECT_EQ(a.shape.mesh()->triangles, b.shape.mesh()->triangles);
}

}  // namespace
}  // namespace evenmesh
