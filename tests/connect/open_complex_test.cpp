/// Label complexes that end where samples have no label.

#include <map>

#include "connect/connect_testing.h"
#include "connect/dual_polygons.h"

namespace evenmesh {
namespace {

/// Boundary edges that go on from each other: closed loops; 0 when they do not.
std::size_t closed_loops(const std::vector<Triangle>& triangles, std::size_t vertices) {
  const HalfEdges edges(triangles, vertices);
  std::map<std::uint32_t, std::uint32_t> next;
  for (std::size_t h = 0; h < 3 * triangles.size(); ++h)
    if (edges.opposite(h) == HalfEdges::none)
      if (!next.insert({triangles[h / 3][h % 3], triangles[h / 3][(h % 3 + 1) % 3]}).second) return 0;
  std::size_t loops = 0;
  while (!next.empty()) {
    const std::uint32_t first = next.begin()->first;
    std::uint32_t at = first;
    do {
      const auto edge = next.find(at);
      if (edge == next.end()) return 0;
      at = edge->second;
      next.erase(edge);
    } while (at != first);
    ++loops;
  }
  return loops;
}

struct Part {
  SampleSet samples;
  std::vector<Vec3> seeds;
  std::vector<std::uint32_t> labels;
  LabelComplex complex;
};

/// Balanced cells of a whole surface; samples where keep(position) is false lose their label.
template <typename Keep>
Part part_of(const Mesh& mesh, std::size_t count, const Keep& keep, unsigned threads = 2) {
  evenmesh::ExecutionContext context(threads);
  Part part;
  part.samples = sampled(mesh, 60);
  part.seeds = relaxed_seeds(part.samples, count);
  part.labels = nearest_labels(part.samples, part.seeds);
  const auto points = positions_of(part.samples);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!keep(points[i])) part.labels[i] = no_label;
  part.complex = with_threads(context, [&] { return connect_labels(part.samples, part.labels, part.seeds, context); });
  return part;
}

void expect_labels_kept_out(const Part& part) {
  for (const std::uint32_t l : part.labels) EXPECT_TRUE(l == no_label || l < part.complex.labels);
  for (const Triangle& t : part.complex.triangles)
    for (const std::uint32_t l : t) EXPECT_LT(l, part.complex.labels);
}

TEST(OpenComplex, OfHalfASphereIsADisc) {
  const Vec3 cuts[] = {{0, 0, 1}, {1, 0, 0}, normalized({1, 2, 3}), normalized({-1, 1, 0.2})};
  for (const Vec3& up : cuts) {
    const Part part = part_of(make_icosphere(4), 250, [&](const Vec3& p) { return dot(p, up) > 0.1; });
    expect_labels_kept_out(part);
    EXPECT_TRUE(part.complex.defects.empty());
    EXPECT_TRUE(manifold_defects(part.complex.triangles, part.complex.labels, true).empty());
    EXPECT_EQ(euler_of(part.complex.triangles), 1);
    EXPECT_EQ(closed_loops(part.complex.triangles, part.complex.labels), 1u);
    std::size_t beyond = 0;
    for (const Triangle& t : part.complex.triangles)
      for (const std::uint32_t l : t) beyond += l < part.seeds.size() && dot(part.seeds[l], up) < -0.2;
    EXPECT_EQ(beyond, 0u);
  }
}

TEST(OpenComplex, WithTwoCapsCutOffIsATube) {
  const Part part = part_of(make_icosphere(4), 250, [](const Vec3& p) { return std::abs(p.z) < 0.6; });
  EXPECT_TRUE(part.complex.defects.empty());
  EXPECT_EQ(euler_of(part.complex.triangles), 0);
  EXPECT_EQ(closed_loops(part.complex.triangles, part.complex.labels), 2u);
}

TEST(OpenComplex, InPiecesStaysInPieces) {
  const Part part = part_of(make_torus(), 300, [](const Vec3& p) { return std::abs(p.x) > 0.25; });
  EXPECT_TRUE(part.complex.defects.empty());
  EXPECT_EQ(euler_of(part.complex.triangles), 0) << "two tubes";
  EXPECT_EQ(closed_loops(part.complex.triangles, part.complex.labels), 4u);
}

TEST(OpenComplex, WithoutAnyLabelIsEmpty) {
  const Part part = part_of(make_icosphere(3), 50, [](const Vec3&) { return false; });
  EXPECT_TRUE(part.complex.triangles.empty());
  EXPECT_TRUE(part.complex.pieces.empty());
}

TEST(OpenComplex, CellsCutInTwoAreSplit) {
  // A gap along the equator: the cells on it lie on both sides.
  const Part part = part_of(make_icosphere(4), 60, [](const Vec3& p) { return std::abs(p.z) > 0.08; });
  expect_labels_kept_out(part);
  EXPECT_FALSE(part.complex.pieces.empty());
  EXPECT_EQ(part.complex.labels, part.seeds.size() + part.complex.pieces.size());
  std::map<std::uint32_t, int> sides;
  const auto points = positions_of(part.samples);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (part.labels[i] != no_label) sides[part.labels[i]] |= points[i].z > 0 ? 1 : 2;
  for (const auto& [label, which] : sides) EXPECT_NE(which, 3) << label;
}

TEST(OpenComplex, FrayedHolesHaveNoDefectsThatAreNotTold) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random random(seed);
    const Part part = part_of(make_torus(), 200, [&](const Vec3&) { return random.below(12) != 0; });
    expect_labels_kept_out(part);
    const auto bad = manifold_defects(part.complex.triangles, part.complex.labels, true);
    for (const auto& defect : bad)
      EXPECT_TRUE(std::binary_search(part.complex.defects.begin(), part.complex.defects.end(), defect));
  }
}

TEST(OpenComplex, SameBitsForAnyNumberOfThreads) {
  const auto keep = [](const Vec3& p) { return p.z > 0.05; };
  const Part one = part_of(make_torus(), 300, keep, 1), three = part_of(make_torus(), 300, keep, 3);
  EXPECT_EQ(one.complex.triangles, three.complex.triangles);
  EXPECT_EQ(one.complex.defects, three.complex.defects);
  EXPECT_EQ(one.labels, three.labels);
}

TEST(ManifoldDefects, OfAClosedMeshAreNoneEitherWay) {
  const Mesh mesh = make_torus();
  EXPECT_TRUE(manifold_defects(mesh.triangles, mesh.vertices.size(), false).empty());
  EXPECT_TRUE(manifold_defects(mesh.triangles, mesh.vertices.size(), true).empty());
}

TEST(ManifoldDefects, OpenTellsBoundariesFromEdgesOfThree) {
  const Mesh plane = make_grid_plane(3, 2);
  EXPECT_EQ(manifold_defects(plane.triangles, plane.vertices.size(), false).size(), 10u) << "its boundary";
  EXPECT_TRUE(manifold_defects(plane.triangles, plane.vertices.size(), true).empty());
  const std::vector<Triangle> fin{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, against{{0, 1, 2}, {0, 1, 3}};
  for (const auto& triangles : {fin, against}) {
    const Defects bad = manifold_defects(triangles, 5, true);
    ASSERT_FALSE(bad.empty());
    for (const auto& defect : bad) EXPECT_EQ(defect, std::pair(0u, 1u));
  }
}

TEST(ManifoldDefects, OpenLetsSeveralFansMeet) {
  const std::vector<Triangle> bowtie{{0, 1, 2}, {0, 3, 4}};
  EXPECT_TRUE(manifold_defects(bowtie, 5, true).empty());
}

TEST(Pillows, AreTakenOutAndNothingElse) {
  std::vector<Triangle> triangles{{0, 1, 2}, {2, 1, 0}, {3, 4, 5}, {3, 5, 6}, {3, 6, 4}, {4, 6, 5}};
  EXPECT_EQ(remove_two_triangle_spheres(triangles, 7), 1u);
  EXPECT_EQ(triangles, (std::vector<Triangle>{{3, 4, 5}, {3, 5, 6}, {3, 6, 4}, {4, 6, 5}}));
  EXPECT_EQ(remove_two_triangle_spheres(triangles, 7), 0u);
}

}  // namespace
}  // namespace evenmesh
