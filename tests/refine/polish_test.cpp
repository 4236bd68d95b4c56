#include "refine/polish.h"

#include "refine/flips.h"
#include "refine/refine_testing.h"

namespace evenmesh {
namespace {

TEST(Polish, NeverLowersTheWorstScore) {
  evenmesh::Run run(1);
  const Shape shape = gallery_shape("sphere");
  const auto projector = make_projector(shape, shape.bounds, run);
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const Projector* onto :
         {static_cast<const Projector*>(nullptr), static_cast<const Projector*>(projector.get())}) {
      Mesh mesh = shaken_sphere(3, 0.025, seed);
      flip_to_delaunay(mesh);
      const auto triangles = mesh.triangles;
      const double before = worst_score(mesh), volume = volume_of(mesh);
      EXPECT_GT(polish(mesh, onto, run), 0u);
      EXPECT_GE(worst_score(mesh), before);
      EXPECT_EQ(mesh.triangles, triangles);
      EXPECT_NEAR(volume_of(mesh), volume, 0.05);
      if (onto == nullptr) continue;
      for (const Vec3& v : mesh.vertices) EXPECT_NEAR(norm(v), 1, 1e-9);
    }
}

TEST(Polish, LeavesGoodTrianglesAlone) {
  evenmesh::Run run(1);
  Mesh mesh = make_icosphere(3);
  const auto vertices = mesh.vertices;
  EXPECT_EQ(polish(mesh, nullptr, run), 0u);
  EXPECT_EQ(mesh.vertices, vertices);
}

TEST(Polish, ScoreIsOneForGoodTrianglesAndZeroForNone) {
  EXPECT_GT(VertexRings::score({0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}), 1.3);
  EXPECT_EQ(VertexRings::score({0, 0, 0}, {0, 0, 0}, {1, 0, 0}), 0);
  EXPECT_NEAR(VertexRings::score({0, 0, 0}, {1, 0, 0}, {2, 0, 0}), 0, 1e-12);
  // Half a square: smallest angle 45°, Q = 3 / (√3 · (1 + 1/√2) · √2).
  EXPECT_NEAR(VertexRings::score({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
              3 / (std::sqrt(3.0) * (1 + std::sqrt(0.5)) * std::sqrt(2.0)) / 0.7, 1e-9);
}

}  // namespace
}  // namespace evenmesh
