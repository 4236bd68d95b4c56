/// Scanned and modelled surfaces, where the folder of the test models is at hand.

#include <cstdlib>
#include <filesystem>

#include "evenmesh/io.h"
#include "pipeline/shell_testing.h"

namespace evenmesh {
namespace {

std::filesystem::path data_file(const std::string& name) {
  if (const char* folder = std::getenv("EVENMESH_DATA")) return std::filesystem::path(folder) / name;
  return std::filesystem::path(EVENMESH_SOURCE_DIR) / ".." / "shared" / "data" / name;
}

struct Model {
  const char* name;
  std::size_t vertices;
  int euler;    ///< 1000: not known
  bool closed;  ///< whether it must be
  friend void PrintTo(const Model& m, std::ostream* out) { *out << m.name; }
};

class BandOfModel : public testing::TestWithParam<Model> {};

TEST_P(BandOfModel, IsATwoManifold) {
  const Model model = GetParam();
  const std::filesystem::path path = data_file(model.name);
  if (!std::filesystem::exists(path))
    GTEST_SKIP() << path << " is not there: set EVENMESH_DATA to the folder of the test models";
  auto input = read_mesh_or_points(path).what;
  const Mesh* mesh = std::get_if<Mesh>(&input);
  const Shape shape = mesh ? shape_from_mesh(*mesh) : shape_from_points(std::get<PointCloud>(input));
  const MeshResult result = meshed(shape, by_shell(model.vertices));
  expect_good_sheet(result);
  EXPECT_GT(result.report.quality.q_avg, 0.85);
  if (model.closed) {
    EXPECT_TRUE(result.report.quality.closed()) << boundary_loops(result.mesh) << " holes";
    EXPECT_GT(result.report.quality.volume, 0);
  }
  if (model.euler != 1000) {
    EXPECT_EQ(result.report.quality.euler, model.euler);
  }
  if (mesh) {
    const double area = measure_quality(*mesh).area;
    EXPECT_NEAR(result.report.quality.area, area, 0.05 * area);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, BandOfModel,
                         testing::Values(Model{"beetle.off", 1500, 1000, false},
                                         Model{"stanford-bunny.obj", 1000, 1000, false},
                                         Model{"kitten.xyz", 800, 0, true}, Model{"bunny-scan.pts", 1000, 1000, false}),
                         [](const auto& of) {
                           std::string name = of.param.name;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return c == '-' || c == '.'; }, '_');
                           return name;
                         });

}  // namespace
}  // namespace evenmesh
