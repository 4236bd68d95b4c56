/// Solids made of others: scenes, boolean, offset.

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "program.h"

namespace evenmesh::test {
namespace {

using Solids = ProgramTest;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

constexpr double ball = 4.0 / 3 * std::numbers::pi;

/// Two unit balls whose centres lie 1 apart have this in common.
constexpr double lens = 5.0 / 12 * std::numbers::pi;

constexpr const char* left_ball = "x^2+y^2+z^2-1";
constexpr const char* right_ball = "(x-1)^2+y^2+z^2-1";
constexpr const char* box_of_balls = "-1.5,-1.5,-1.5,2.5,1.5,1.5";

void expect_solid(const Json& figures, int euler, double volume, double tolerance) {
  EXPECT_TRUE(figures.at("closed").get<bool>());
  EXPECT_TRUE(figures.at("oriented").get<bool>());
  EXPECT_EQ(figures.at("non_manifold_edges"), 0);
  EXPECT_EQ(figures.at("euler"), euler);
  EXPECT_NEAR(figures.at("volume").get<double>(), volume, tolerance * volume);
}

TEST_F(Solids, ScenesOfOneBody) {
  write("tetra.obj", tetrahedron_obj);
  write("moved.json", R"({"transform": {"scale": 2, "translate": [5,0,0]}, "of": {"mesh": "tetra.obj"}})");
  write("cube.csg", "multmatrix([[1,0,0,3],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(size = [1, 2, 3]); }\n");
  write("ball.txt", R"({"implicit": "x^2+y^2+z^2-R^2", "parameters": {"R": 1}})");  // recognized by its content
  ASSERT_EQ(run({"mesh", "moved.json", "-n", "400", "-o", "a.ply", "-q"}).status, 0);
  expect_solid(Json::parse(info("a.ply")), 2, 8.0 / 6, 0.05);
  ASSERT_EQ(run({"mesh", "cube.csg", "-n", "800", "-o", "b.ply", "-q"}).status, 0);
  expect_solid(Json::parse(info("b.ply")), 2, 6, 0.03);
  ASSERT_EQ(run({"mesh", "ball.txt", "-n", "400", "-o", "c.ply", "-q"}).status, 0);
  expect_solid(Json::parse(info("c.ply")), 2, ball, 0.03);
}

TEST_F(Solids, ScenesFromStandardInput) {
  write("tetra.obj", tetrahedron_obj);
  const auto meshed = [&](const std::string& scene) {
    const Outcome outcome = run({"mesh", "-", "-n", "300", "-o", "x.ply", "-q"}, {.input = scene});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Json::parse(info("x.ply"));
  };
  expect_solid(meshed(R"( {"transform": {"scale": 2}, "of": {"mesh": "tetra.obj"}})"), 2, 8.0 / 6, 0.05);
  expect_solid(meshed("// a part\nmultmatrix([[2,0,0,0],[0,2,0,0],[0,0,2,0],[0,0,0,1]]) { import(\"tetra.obj\"); }"), 2,
               8.0 / 6, 0.05);
  const Outcome outcome = run({"mesh", "-", "-o", "x.ply"}, {.input = "group() { cubes(); }"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("standard input: line 1, column 11: "), std::string::npos) << outcome.err;
}

// From here on compounds are sampled, which needs sample_shape() to know them.

TEST_F(Solids, BooleansOfExpressions) {
  const auto made = [&](const char* operation) {
    const Outcome outcome = run({"boolean", operation, "-e", left_ball, "-e", right_ball, "--bounds", box_of_balls,
                                 "-n", "1500", "-o", "x.ply", "--json", "x.json", "-q"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Json::parse(read("x.json"));
  };
  const Json figures = made("union");
  expect_solid(figures, 2, 2 * ball - lens, 0.02);
  EXPECT_EQ(figures.at("options").at("operation"), "union");
  EXPECT_EQ(figures.at("options").at("expressions").size(), 2u);
  expect_solid(made("intersection"), 2, lens, 0.02);
  expect_solid(made("difference"), 2, ball - lens, 0.02);
}

TEST_F(Solids, BooleansTakeTheirOperandsInOrder) {
  write("tetra.obj", tetrahedron_obj);
  write("cube.csg", "cube(size = 0.25);\n");
  // The cube lies in the tetrahedron: its far corner has x + y + z = 0.75.
  const Outcome outcome = run({"boolean", "difference", "tetra.obj", "cube.csg", "-n", "1500", "-o", "x.ply", "-q"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expect_solid(Json::parse(info("x.ply")), 2, 1.0 / 6 - 1.0 / 64, 0.03);
}

TEST_F(Solids, ScenesSayTheSameAsCommands) {
  write("two.json", R"({"union": [{"implicit": "x^2+y^2+z^2-1", "bounds": [-2,-2,-2,2,2,2]},
      {"transform": {"translate": [1,0,0]}, "of": {"implicit": "x^2+y^2+z^2-1", "bounds": [-2,-2,-2,2,2,2]}}]})");
  const Outcome outcome = run({"mesh", "two.json", "-n", "1500", "-o", "x.ply", "-q"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expect_solid(Json::parse(info("x.ply")), 2, 2 * ball - lens, 0.02);
}

TEST_F(Solids, OpenScadDifference) {
  write("part.csg",
        "difference() {\n\tcube(size = [2, 2, 1], center = true);\n\tcylinder($fn = 40, $fa = 12, $fs = 2, h = 4, r1 = "
        "0.5, r2 = 0.5, center = true);\n}\n");
  const Outcome outcome = run({"mesh", "part.csg", "-n", "2500", "-o", "x.ply", "-q"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const double hole = 20 * 0.25 * std::sin(std::numbers::pi / 20);
  expect_solid(Json::parse(info("x.ply")), 0, 4 - hole, 0.03);
}

TEST_F(Solids, OffsetsOfABall) {
  const auto made = [&](const Words& how) {
    Words words{"offset", "-e", left_ball, "--bounds", "-2,-2,-2,2,2,2", "-n", "300", "-r", "60", "-o", "x.ply", "-q"};
    words.insert(words.end(), how.begin(), how.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Json::parse(info("x.ply"));
  };
  expect_solid(made({"--distance", "0.5"}), 2, ball * std::pow(1.5, 3), 0.04);
  expect_solid(made({"--distance", "-0.5"}), 2, ball * std::pow(0.5, 3), 0.08);
  expect_solid(made({"--closing", "0.3"}), 2, ball, 0.04);
  expect_solid(made({"--opening", "0.3"}), 2, ball, 0.04);
}

}  // namespace
}  // namespace evenmesh::test
