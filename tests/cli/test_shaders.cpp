/// Shaders as inputs: what they become, and what is said to those that cannot be meshed.

#include <nlohmann/json.hpp>
#include <numbers>

#include "program.h"

namespace evenmesh::test {
namespace {

using Shaders = ProgramTest;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

constexpr double ball = 4.0 / 3 * std::numbers::pi;
constexpr const char* sphere = "uniform float r = 1.0;\nfloat map(vec3 p) { return length(p) - r; }\n";

void expect_ball(const Json& figures, double volume) {
  EXPECT_TRUE(figures.at("closed").get<bool>());
  EXPECT_EQ(figures.at("euler"), 2);
  EXPECT_NEAR(figures.at("volume").get<double>(), volume, 0.03 * volume);
}

TEST_F(Shaders, BecomeMeshes) {
  write("ball.glsl", sphere);
  ASSERT_EQ(run({"mesh", "ball.glsl", "-n", "500", "-o", "a.ply", "-q"}).status, 0);
  expect_ball(Json::parse(info("a.ply")), ball);
  ASSERT_EQ(run({"mesh", "ball.glsl", "-D", "r=2", "--lipschitz", "1", "-n", "500", "-o", "b.ply", "-q"}).status, 0);
  expect_ball(Json::parse(info("b.ply")), 8 * ball);
  ASSERT_EQ(run({"mesh", "ball.glsl", "--level", "-0.5", "-n", "500", "-o", "c.ply", "-q"}).status, 0);
  expect_ball(Json::parse(info("c.ply")), ball / 8);
  ASSERT_EQ(run({"mesh", "-", "-n", "500", "-o", "d.ply", "-q"}, {.input = sphere}).status, 0);
  EXPECT_EQ(read("d.ply"), read("a.ply"));
}

TEST_F(Shaders, ExpressionsHaveTheSameSurfaceOnOpenGl) {
  for (const Words& what : {Words{"gallery:tangle"}, Words{"-e", "sqrt((sqrt(x^2+y^2)-1)^2+z^2) - a", "-D", "a=0.4"}}) {
    std::vector<Json> figures;
    for (const char* backend : {"cpu", "gl"}) {
      Words words{"mesh", "-n", "1500", "-o", "a.ply", "-q", "--backend", backend};
      words.insert(words.end(), what.begin(), what.end());
      ASSERT_EQ(run(words).status, 0);
      figures.push_back(Json::parse(info("a.ply")));
      EXPECT_TRUE(figures.back().at("closed").get<bool>());
      EXPECT_TRUE(figures.back().at("two_manifold").get<bool>());
    }
    EXPECT_EQ(figures[0].at("euler"), figures[1].at("euler"));
    EXPECT_NEAR(figures[0].at("volume").get<double>(), figures[1].at("volume").get<double>(),
                1e-2 * figures[0].at("volume").get<double>());
  }
}

TEST_F(Shaders, NothingToMoveIsSaid) {
  write("a.obj", tetrahedron_obj);
  const Outcome outcome = run({"mesh", "a.obj", "-n", "100", "-o", "a.ply", "--backend", "gl"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("no expression and no shader"), std::string::npos) << outcome.err;
}

TEST_F(Shaders, StandWhereverAShapeCan) {
  write("ball.glsl", sphere);
  write("two.json", R"({"union": [{"glsl": "ball.glsl"},
    {"transform": {"translate": [5, 0, 0]}, "of": {"glsl": "ball.glsl", "parameters": {"r": 0.5}}}]})");
  ASSERT_EQ(run({"mesh", "two.json", "-n", "800", "-o", "a.ply", "-q"}).status, 0);
  const Json two = Json::parse(info("a.ply"));
  EXPECT_EQ(two.at("components"), 2);
  EXPECT_NEAR(two.at("volume").get<double>(), 1.125 * ball, 0.04 * ball);
  ASSERT_EQ(run({"offset", "ball.glsl", "--distance", "0.5", "-n", "500", "-o", "b.ply", "-q"}).status, 0);
  expect_ball(Json::parse(info("b.ply")), 3.375 * ball);
  ASSERT_EQ(
      run({"boolean", "difference", "ball.glsl", "gallery:cube", "-e", "x", "-n", "500", "-o", "c.ply", "-q"}).status,
      3)
      << "a ball within the cube is nothing";
}

TEST_F(Shaders, ThatCannotBeMeshedAreNamedWithAReason) {
  write("syntax.glsl", "float map(vec3 p) {\n  return length(p) - ;\n}\n");
  write("entry.glsl", "float scene(vec3 p) { return length(p) - 1.0; }\n");
  write("endless.glsl", "float map(vec3 p) { float a = 0.0; for (;;) a += 1.0; return a; }\n");
  write("nan.glsl", "float map(vec3 p) { return sqrt(-1.0 - dot(p, p)); }\n");
  write("positive.glsl", "float map(vec3 p) { return abs(length(p) - 1.0) + 0.01; }\n");
  write("floor.glsl", "float map(vec3 p) { return p.y; }\n");
  write("ball.glsl", sphere);
  write("empty.glsl", "\n");
  struct Case {
    Words words;
    int status;
    const char* fragment;
  };
  const std::vector<Case> cases{
      {{"syntax.glsl"}, 3, "syntax.glsl:2:"},
      {{"empty.glsl"}, 3, "empty.glsl: is empty"},
      {{"entry.glsl"}, 2, "--entry scene"},
      {{"endless.glsl"}, 3, "does not end"},
      {{"nan.glsl"}, 3, "not a finite number"},
      {{"positive.glsl"}, 3, "--level"},
      {{"floor.glsl"}, 3, "--bounds"},
      {{"ball.glsl", "-D", "radius=1"}, 2, "radius"},
      {{"ball.glsl", "--lipschitz", "0"}, 2, "--lipschitz"},
      {{"ball.glsl", "--gl-device", "no such card"}, 2, "no such card"},
      {{"ball.glsl", "--bounds", "3,3,3,4,4,4"}, 3, "no surface within its bounds"},
      {{"gallery:sphere", "--entry", "de"}, 2, "--entry"},
      {{"missing.glsl"}, 3, "missing.glsl: no such file"},
  };
  const Words before = names();
  for (const Case& c : cases) {
    Words words{"mesh", "-o", "x.ply"};
    words.insert(words.begin() + 1, c.words.begin(), c.words.end());
    SCOPED_TRACE(testing::PrintToString(words));
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, c.status) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("error: ")) << outcome.err;
    EXPECT_NE(outcome.err.find(c.fragment), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(names(), before) << "nothing is written";
  EXPECT_EQ(run({"mesh", "ball.glsl", "--bounds", "0,-2,-2,2,2,2", "-n", "300", "-o", "half.ply", "-q"}).status, 0)
      << "cut by the box: capped, with a warning";
}

TEST_F(Shaders, TheRendererIsNamed) {
  const Outcome outcome = run({"--version", "-v"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.out.find("OpenGL 4."), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace evenmesh::test
