/// Solids that shaders draw.

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "program.h"

namespace evenmesh::test {
namespace {

using Raster = ProgramTest;
using Json = nlohmann::json;

const std::string examples = std::string(EVENMESH_SOURCE_DIR) + "/examples/raster/";

void expect_solid(const Json& figures, int euler, double volume) {
  EXPECT_TRUE(figures.at("closed").get<bool>());
  EXPECT_TRUE(figures.at("oriented").get<bool>());
  EXPECT_EQ(figures.at("non_manifold_edges"), 0);
  EXPECT_EQ(figures.at("euler"), euler);
  EXPECT_NEAR(figures.at("volume").get<double>(), volume, 0.03 * volume);
}

TEST_F(Raster, DrawsTheExamples) {
  const Outcome first = run({"mesh", "--raster", examples + "quadric.vert", examples + "quadric.frag",
                             "--raster-vertices", "72", "--bounds=-1,-1,-1,1,1,1", "-n", "1000", "-o", "a.ply", "-q"});
  ASSERT_EQ(first.status, 0) << first.err;
  expect_solid(Json::parse(info("a.ply")), 2, 4.0 / 3 * std::numbers::pi / std::sqrt(1.2 * 2 * 4));
  ASSERT_EQ(run({"mesh", "--raster", examples + "twist.vert", "default", "--raster-vertices", "12288",
                 "--bounds=-1.5,-1.5,-0.5,1.5,1.5,0.5", "-n", "2000", "-o", "b.ply", "-q"})
                .status,
            0);
  expect_solid(Json::parse(info("b.ply")), 0, 2 * std::numbers::pi * 0.32);
  ASSERT_EQ(run({"gallery", "sphere", "-n", "500", "-o", "ball.ply", "-q"}).status, 0);
  ASSERT_EQ(run({"mesh", "--raster", "default", examples + "plain.frag", "ball.ply", "-n", "400", "-o", "c.ply", "-q"})
                .status,
            0);
  EXPECT_TRUE(Json::parse(info("c.ply")).at("closed").get<bool>());
}

TEST_F(Raster, DrawsOpenSurfacesAndPartsOfScenes) {
  const Outcome sheet = run({"mesh", "--raster", examples + "sheet.vert", "default", "--raster-vertices", "60000",
                             "--bounds=-1.2,-1.2,-0.5,1.2,1.2,0.5", "-n", "500", "-o", "a.ply", "-q"});
  ASSERT_EQ(sheet.status, 0) << sheet.err;
  const Json figures = Json::parse(info("a.ply"));
  EXPECT_EQ(figures.at("euler"), 1);
  EXPECT_EQ(figures.at("non_manifold_edges"), 0);
  EXPECT_GT(figures.at("boundary_edges"), 40);
  // A ring that is drawn, and half of it taken away.
  write("scene.json", R"({"difference": [{"raster": [")" + examples + R"(twist.vert", "default"], "vertices": 12288,
        "bounds": [-1.5, -1.5, -0.5, 1.5, 1.5, 0.5], "parameters": {"turns": 0.5}},
      {"implicit": "x", "bounds": [-2, -2, -2, 2, 2, 2]}]})");
  const Outcome half = run({"mesh", "scene.json", "-n", "1500", "-o", "b.ply", "-q"});
  ASSERT_EQ(half.status, 0) << half.err;
  expect_solid(Json::parse(info("b.ply")), 2, std::numbers::pi * 0.32);
}

TEST_F(Raster, NamesTheUsersFileAndLine) {
  write("tetra.obj", tetrahedron_obj);
  write("bad.frag", "void main() {\n  float x = nothing;\n}\n");
  const Outcome outcome = run({"mesh", "--raster", "default", "bad.frag", "tetra.obj", "-o", "x.ply"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("bad.frag:2:13"), std::string::npos) << outcome.err;
  const Outcome missing = run({"mesh", "--raster", "default", "none.frag", "tetra.obj", "-o", "x.ply"});
  EXPECT_EQ(missing.status, 3);
  EXPECT_NE(missing.err.find("none.frag"), std::string::npos) << missing.err;
  const Outcome nowhere =
      run({"mesh", "--raster", examples + "twist.vert", "default", "--raster-vertices", "12288", "-o", "x.ply"});
  EXPECT_EQ(nowhere.status, 2);
  EXPECT_NE(nowhere.err.find("--bounds"), std::string::npos) << nowhere.err;
}

}  // namespace
}  // namespace evenmesh::test
