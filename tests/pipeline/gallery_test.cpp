#include "pipeline/gallery_checks.h"

namespace evenmesh {
namespace testing {

INSTANTIATE_TEST_SUITE_P(Gallery, EasyShape,
                         ::testing::Values(Easy{on_cpu, "sphere", 5000}, Easy{on_cpu, "octic", 5000},
                                           Easy{on_cpu, "tangle", 5000}, Easy{on_cpu, "menger-2", 5000}),
                         name_of_easy);

}  // namespace testing
namespace {

/// The difficult shapes of the gallery: thin walls, many handles, places where the surface touches itself.
struct Difficult {
  const char* name;
  std::size_t vertices;
  friend void PrintTo(const Difficult& d, std::ostream* out) {
    *out << d.name << " with " << d.vertices << " vertices";
  }
};

class DifficultShape : public ::testing::TestWithParam<Difficult> {};

TEST_P(DifficultShape, IsClosedAndTwoManifoldWithItsTopology) {
  const auto [name, vertices] = GetParam();
  const MeshResult result = meshed(gallery_shape(name), {.vertices = vertices});
  expect_good_mesh(result);
  expect_count(result, vertices);
  EXPECT_GT(result.report.quality.q_avg, 0.8);
  for (const GalleryEntry& entry : gallery())
    if (entry.name == name && entry.euler) {
      EXPECT_EQ(result.report.quality.euler, *entry.euler);
    }
  const MeshResult alone = meshed(gallery_shape(name), {.vertices = vertices}, 1);
  EXPECT_TRUE(same_mesh(result.mesh, alone.mesh)) << "one thread must give what two give";
}

INSTANTIATE_TEST_SUITE_P(Gallery, DifficultShape,
                         ::testing::Values(Difficult{"thin-torus", 300}, Difficult{"thin-plate", 1000},
                                           Difficult{"octic", 300}, Difficult{"menger-2", 500}, Difficult{"klein", 600},
                                           Difficult{"barth", 800}, Difficult{"trig", 500}, Difficult{"schwarz-p", 800},
                                           Difficult{"heart", 600}),
                         [](const auto& of) {
                           std::string name = of.param.name;
                           std::erase(name, '-');
                           return name;
                         });

TEST(TopologyRepair, TopologyThatNeedsMoreVerticesGetsThem) {
  const MeshResult result = meshed(gallery_shape("menger-2"), {.vertices = 300, .quality = Quality::fast});
  expect_good_mesh(result);
  EXPECT_EQ(result.report.quality.euler, -160);
  EXPECT_GT(result.mesh.vertices.size(), 300u);
  EXPECT_GT(result.report.inserted_seeds, 0u);
  EXPECT_TRUE(has_finding(result.report, FindingCode::vertex_count));
}

TEST(TopologyRepair, SurfacesThatTouchAreRegularized) {
  // The Klein bottle's solid touches itself along a curve: what the grid sees there is chance.
  const MeshResult result = meshed(gallery_shape("klein"), {.vertices = 1000});
  expect_good_mesh(result);
  EXPECT_GT(result.report.regularization_rounds, 0u);
  EXPECT_TRUE(has_finding(result.report, FindingCode::gaps_filled));
}

}  // namespace
}  // namespace evenmesh
