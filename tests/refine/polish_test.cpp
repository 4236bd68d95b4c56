#include "refine/polish.h"

#include "refine/flips.h"
#include "refine/refine_testing.h"

namespace evenmesh {
namespace {

TEST(Polish, NeverLowersTheWorstScore) {
  evenmesh::ExecutionContext context(1);
  const Shape shape = gallery_shape("sphere");
  const auto projector = make_projector(shape, shape.bounds, context);
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const Projector* onto :
         {static_cast<const Projector*>(nullptr), static_cast<const Projector*>(projector.get())}) {
      Mesh mesh = perturbed_sphere(3, 0.025, seed);
      flip_to_delaunay(mesh);
      const auto triangles = mesh.triangles;
      const double before = worst_score(mesh), volume = volume_of(mesh);
      EXPECT_GT(polish(mesh, onto, context), 0u);
      EXPECT_GE(worst_score(mesh), before);
      EXPECT_EQ(mesh.triangles, triangles);
      EXPECT_NEAR(volume_of(mesh), volume, 0.05);
      if (onto == nullptr) continue;
      for (const Vec3& v : mesh.vertices) EXPECT_NEAR(norm(v), 1, 1e-9);
    }
}

TEST(Polish, LeavesGoodTrianglesAlone) {
  evenmesh::ExecutionContext context(1);
  Mesh mesh = make_icosphere(3);
  const auto vertices = mesh.vertices;
  EXPECT_EQ(polish(mesh, nullptr, context), 0u);
  EXPECT_EQ(mesh.vertices, vertices);
}

/// A shaken torus whose outermost vertices are held on the circle there.
struct HeldTorus {
  explicit HeldTorus(std::uint64_t seed) : mesh(make_torus(1, 0.35, 24, 8)) {
    constexpr int pieces = 240;
    FeatureCurve circle;
    for (int i = 0; i <= pieces; ++i) {
      const double angle = 2 * std::numbers::pi * (i % pieces) / pieces;
      circle.points.push_back({1.35 * std::cos(angle), 1.35 * std::sin(angle), 0});
      circle.arc.push_back(i);
    }
    constraints.features.curves.push_back(circle);
    Random random(seed);
    const auto shaken = [&] { return 0.16 * (random.uniform() - 0.5); };
    for (Vec3& v : mesh.vertices) {
      const bool fixed = std::abs(std::hypot(v.x, v.y) - 1.35) < 1e-9;
      constraints.curve.push_back(fixed ? 0 : VertexConstraints::free);
      if (!fixed) v += {shaken(), shaken(), shaken()};
    }
    for (const Triangle& t : mesh.triangles)
      for (std::size_t c = 0; c < 3; ++c)
        if (const auto [v, w] = std::minmax(t[c], t[(c + 1) % 3]); constraints.vertex(v) && constraints.vertex(w))
          constraints.edges.push_back({v, w});
    std::sort(constraints.edges.begin(), constraints.edges.end());
  }
  double chordal_deviation() const {
    const VertexRings rings(mesh);
    double most = 0;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
      if (constraints.vertex(v)) most = std::max(most, constraints.chordal_deviation(mesh, v, rings.neighbours(v)));
    return most;
  }

  Mesh mesh;
  VertexConstraints constraints;
};

TEST(Polish, DoesNotSlideVerticesSoFarThatTheyCutTheirCreaseOff) {
  evenmesh::ExecutionContext context(1);
  const double even = 1.35 * (1 - std::cos(std::numbers::pi / 24));
  double unlimited = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    for (const double most : {1.1 * even, 10.0}) {
      HeldTorus torus(seed);
      EXPECT_NEAR(torus.chordal_deviation(), even, 1e-3);
      torus.constraints.max_chordal_deviation = most;
      EXPECT_GT(polish(torus.mesh, nullptr, context, torus.constraints), 0u);
      if (most > 1)
        unlimited = std::max(unlimited, torus.chordal_deviation());
      else
        EXPECT_LE(torus.chordal_deviation(), 1.1 * even + 1e-12);
    }
  EXPECT_GT(unlimited, 1.2 * even) << "or the limit is not tested";
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
