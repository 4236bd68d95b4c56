/// A program built without OpenGL says so to whoever wants it, and does everything else.

#include "cli/program.h"

namespace evenmesh::test {
namespace {

using ProgramWithoutGl = ProgramTest;
using Words = std::vector<std::string>;

TEST_F(ProgramWithoutGl, RefusesWhatNeedsIt) {
  write("ball.glsl", "float map(vec3 p) { return length(p) - 1.0; }\n");
  write("ball.json", R"({"union": [{"gallery": "cube"}, {"glsl": "ball.glsl"}]})");
  write("tetra.obj", tetrahedron_obj);
  const std::vector<Words> commands{
      {"mesh", "ball.glsl"},
      {"mesh", "ball.json"},
      {"offset", "ball.glsl", "--distance", "0.1"},
      {"boolean", "union", "gallery:cube", "ball.glsl"},
      {"mesh", "--raster", "default", "default", "tetra.obj"},
      {"mesh", "gallery:sphere", "--backend", "gl"},
  };
  const Words before = names();
  for (Words words : commands) {
    SCOPED_TRACE(testing::PrintToString(words));
    words.insert(words.end(), {"-n", "100", "-o", "x.ply"});
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(outcome.err.starts_with("error: ")) << outcome.err;
    EXPECT_NE(outcome.err.find("built without OpenGL"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("-DEVENMESH_GL=ON"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(names(), before) << "nothing is written";
}

TEST_F(ProgramWithoutGl, SaysSoWithItsVersion) {
  const Outcome outcome = run({"--version", "-v"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.out.find("shaders: none (evenmesh was built without OpenGL"), std::string::npos) << outcome.out;
}

TEST_F(ProgramWithoutGl, MeshesTheRest) {
  EXPECT_EQ(run({"mesh", "gallery:sphere", "-n", "100", "-o", "x.ply", "-q", "--backend", "cpu"}).status, 0);
}

}  // namespace
}  // namespace evenmesh::test
