/// What the program does when it works: files, streams, reports, interruption.

#include <cmath>
#include <nlohmann/json.hpp>

#include "program.h"

namespace evenmesh::test {
namespace {

using Jobs = ProgramTest;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

void expect_sound(const Json& figures) {
  EXPECT_TRUE(figures.at("closed").get<bool>());
  EXPECT_TRUE(figures.at("oriented").get<bool>());
  EXPECT_EQ(figures.at("boundary_edges"), 0);
  EXPECT_EQ(figures.at("non_manifold_edges"), 0);
  EXPECT_EQ(figures.at("non_manifold_vertices"), 0);
}

TEST_F(Jobs, MeshesABuiltInShape) {
  const Outcome outcome = run({"mesh", "gallery:sphere", "-n", "400", "-o", "s.ply"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("two-manifold"), std::string::npos) << outcome.out;
  const Json figures = Json::parse(info("s.ply"));
  expect_sound(figures);
  EXPECT_EQ(figures.at("euler"), 2);
  EXPECT_EQ(figures.at("self_intersections"), 0);
  EXPECT_NEAR(figures.at("vertices").get<double>(), 400, 2);
  EXPECT_GT(figures.at("volume").get<double>(), 0);
  EXPECT_EQ(names(), Words{"s.ply"});
}

TEST_F(Jobs, MeshesAnExpressionWithParameters) {
  const Outcome outcome = run({"mesh", "-e", "x^2+y^2+z^2-s*s", "-D", "s=2", "-n", "300", "-o", "s.obj", "-q"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out + outcome.err, "") << "quiet means quiet";
  const Json figures = Json::parse(info("s.obj"));
  expect_sound(figures);
  EXPECT_NEAR(figures.at("area").get<double>(), 50.3, 2.5);
}

TEST_F(Jobs, DensitiesTakeParametersWhateverIsMeshed) {
  const Words words{"mesh", "gallery:sphere", "-n", "300", "-D", "k=3", "-o", "s.ply", "-q"};
  EXPECT_EQ(run(words).status, 2) << "nothing takes k";
  Words dense = words;
  dense.insert(dense.end(), {"--density", "1 + k*x^2"});
  EXPECT_EQ(run(dense).status, 0);
}

TEST_F(Jobs, WritesEveryFormat) {
  for (const char* format : {"ply", "obj", "stl", "off", "glb", "3mf"}) {
    const std::string name = std::string("s.") + format;
    ASSERT_EQ(run({"mesh", "gallery:sphere", "-n", "100", "-o", name}).status, 0) << name;
    const Json figures = Json::parse(info(name));
    expect_sound(figures);
    EXPECT_EQ(figures.at("euler"), 2) << name;
  }
}

TEST_F(Jobs, SurveyCoordinatesStayExactInEveryFormat) {
  write("far.csg",
        "multmatrix([[1, 0, 0, 691003.37], [0, 1, 0, 5336001.21], [0, 0, 1, 519.3], [0, 0, 0, 1]]) { cube(size = "
        "[1, 2, 0.5], center = false); }\n");
  for (const char* format : {"ply", "obj", "stl", "off", "glb", "3mf"}) {
    const std::string name = std::string("far.") + format;
    const Outcome outcome = run({"mesh", "far.csg", "-n", "300", "-o", name});
    ASSERT_EQ(outcome.status, 0) << name << ' ' << outcome.err;
    const Json figures = Json::parse(info(name));
    expect_sound(figures);
    EXPECT_NEAR(figures.at("volume").get<double>(), 1, 1e-5) << name;
    EXPECT_NEAR(figures.at("area").get<double>(), 7, 1e-4) << name;
  }
}

TEST_F(Jobs, StreamsInAndOut) {
  const Outcome first = run({"mesh", "-", "-n", "200", "-o", "-"}, {.input = tetrahedron_obj});
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_TRUE(first.out.starts_with("ply\n"));
  const Outcome second = run({"info", "-", "--json"}, {.input = first.out});
  ASSERT_EQ(second.status, 0) << second.err;
  expect_sound(Json::parse(second.out));
  const Outcome text = run({"mesh", "-", "-n", "200", "-o", "-", "--format", "off", "-q"}, {.input = tetrahedron_obj});
  EXPECT_TRUE(text.out.starts_with("OFF")) << text.out.substr(0, 40);
  EXPECT_EQ(names(), Words{});
}

TEST_F(Jobs, ThreadsDoNotChangeTheBytes) {
  write("a.obj", tetrahedron_obj);
  for (const char* input : {"gallery:trig", "a.obj"}) {
    const Outcome one = run({"mesh", input, "-n", "500", "-j", "1", "-o", "-", "-q"});
    const Outcome three = run({"mesh", input, "-n", "500", "-j", "3", "-o", "-", "-q"});
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_TRUE(one.out == three.out) << input;
  }
}

TEST_F(Jobs, OutputMayBeTheInput) {
  write("a.obj", tetrahedron_obj);
  ASSERT_EQ(run({"mesh", "a.obj", "-n", "150", "-o", "a.obj"}).status, 0);
  EXPECT_NEAR(Json::parse(info("a.obj")).at("vertices").get<double>(), 150, 1);
  EXPECT_EQ(names(), Words{"a.obj"});
}

TEST_F(Jobs, AFailureLeavesTheOldFile) {
  write("x.ply", "precious");
  EXPECT_NE(run({"mesh", "missing.obj", "-o", "x.ply"}).status, 0);
  EXPECT_NE(run({"mesh", "-e", "x^2+y^2+z^2+1", "-o", "x.ply"}).status, 0);
  EXPECT_EQ(read("x.ply"), "precious");
  EXPECT_EQ(names(), Words{"x.ply"});
}

TEST_F(Jobs, ADeviceIsWrittenToItself) {
  EXPECT_EQ(run({"mesh", "gallery:sphere", "-n", "50", "-o", "/dev/null"}).status, 0);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  const Outcome full = run({"mesh", "gallery:sphere", "-n", "50", "-o", "/dev/full"});
  EXPECT_EQ(full.status, 1);
  EXPECT_TRUE(full.err.starts_with("error: ")) << full.err;
}

TEST_F(Jobs, ReportsItsRun) {
  const Outcome outcome = run(
      {"mesh", "gallery:torus", "-n", "300", "-o", "t.ply", "--json", "t.json", "--report", "t.html", "--seed", "7"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json figures = Json::parse(read("t.json"));
  for (const char* key : {"vertices",
                          "faces",
                          "q_min",
                          "q_avg",
                          "theta_min",
                          "theta_avg",
                          "irregular_ratio",
                          "boundary_edges",
                          "non_manifold_edges",
                          "non_manifold_vertices",
                          "components",
                          "euler",
                          "closed",
                          "oriented",
                          "area",
                          "volume",
                          "edge_length_avg",
                          "seeds",
                          "samples",
                          "alpha",
                          "energy_ratio",
                          "evaluations",
                          "regularization_rounds",
                          "seconds",
                          "peak_memory_bytes",
                          "version",
                          "options"}) {
    EXPECT_TRUE(figures.contains(key)) << key;
  }
  EXPECT_EQ(figures.at("euler"), 0);
  EXPECT_EQ(figures.at("options").at("seed"), 7);
  EXPECT_TRUE(figures.at("seconds").is_object());
  const std::string html = read("t.html");
  EXPECT_NE(html.find("<html"), std::string::npos);
  EXPECT_EQ(html.find("http://"), html.find("http://www.w3.org")) << "the page needs nothing from elsewhere";
}

TEST_F(Jobs, InfoComparesRenders) {
  write("a.obj", tetrahedron_obj);
  const Outcome table = run({"info", "a.obj"});
  EXPECT_EQ(table.status, 0);
  EXPECT_NE(table.out.find("Euler number 2"), std::string::npos) << table.out;
  const Outcome same = run({"compare", "a.obj", "a.obj", "--json", "--samples", "1000"});
  ASSERT_EQ(same.status, 0) << same.err;
  EXPECT_NEAR(Json::parse(same.out).at("hausdorff").get<double>(), 0, 1e-9);
  EXPECT_EQ(run({"compare", "a.obj", "a.obj", "--samples", "1000"}).status, 0);
  for (const Words& more : {Words{}, Words{"--quality"}, Words{"--compare", "a.obj", "--view", "10,80", "--up", "z"}}) {
    Words words{"render", "a.obj", "-o", "a.png", "--width", "64", "--height", "48"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(read("a.png").starts_with("\x89PNG"));
  }
}

TEST_F(Jobs, WrapClosesAnOpenSheet) {
  write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  EXPECT_EQ(run({"wrap", "sheet.obj", "-n", "300", "-o", "out.ply", "-q"}).status, 0);
  EXPECT_NE(info("out.ply").find("\"closed\": true"), std::string::npos);
  EXPECT_EQ(run({"wrap", "sheet.obj", "--method", "raster", "-n", "300", "-o", "other.ply"}).status, 2);
}

TEST_F(Jobs, InfoOnPoints) {
  write("two.ply", points_ply);
  write("three.pts", "3\n0 0 0\n1 0 0\n0 -2 0\n");
  const Json two = Json::parse(info("two.ply"));
  EXPECT_EQ(two.at("points"), 2);
  EXPECT_EQ(two.at("normals"), true);
  EXPECT_EQ(two.at("spacing"), 5);
  EXPECT_EQ(two.at("bounds"), (Json{0, 0, 0, 0, 3, 4}));
  EXPECT_EQ(Json::parse(info("three.pts")).at("normals"), false);
  const Outcome table = run({"info", "-"}, {.input = "0 0 0\n3 4 0\n"});
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_TRUE(table.out.starts_with("standard input\n  points ")) << table.out;
  for (const Words& words : {Words{"compare", "two.ply", "two.ply"}, Words{"render", "two.ply", "-o", "x.png"}}) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 3);
    EXPECT_NE(outcome.err.find("two.ply: holds no triangles, only 2 points"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(names(), (Words{"three.pts", "two.ply"}));
}

TEST_F(Jobs, MeshesPoints) {
  std::string points;  // evenly on a ball, by the golden angle
  for (int i = 0; i < 2000; ++i) {
    const double z = 1 - (i + 0.5) / 1000, ring = std::sqrt(1 - z * z), angle = 2.399963 * i;
    points += std::to_string(ring * std::cos(angle)) + ' ' + std::to_string(ring * std::sin(angle)) + ' ' +
              std::to_string(z) + '\n';
  }
  write("ball.xyz", points);
  const Outcome outcome = run({"mesh", "ball.xyz", "-n", "200", "-o", "ball.ply", "--json", "ball.json", "-q"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const Json figures = Json::parse(read("ball.json"));
  EXPECT_EQ(figures.at("euler"), 2);
  EXPECT_EQ(figures.at("closed"), true);
  for (const char* key : {"sites", "shell_voxels", "thickness", "sheets", "cuts"})
    EXPECT_TRUE(figures.contains(key)) << key;
}

TEST_F(Jobs, PointsOfALineHaveNoSurfaceIsStatus3) {
  write("line.xyz", "0 0 0\n1 1 1\n2 2 2\n3 3 3\n4 4 4\n");
  write("equal.xyz", "1 2 3\n1 2 3\n1 2 3\n");
  for (const char* name : {"line.xyz", "equal.xyz"}) {
    const Outcome outcome = run({"mesh", name, "-n", "100", "-o", "x.ply"});
    EXPECT_EQ(outcome.status, 3) << name << ": " << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("error: ")) << outcome.err;
  }
  EXPECT_EQ(names(), (Words{"equal.xyz", "line.xyz"}));
}

TEST_F(Jobs, MeshesOpenSheets) {
  write("corner.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n");
  const Outcome outcome = run({"mesh", "corner.obj", "-n", "200", "-o", "corner.ply", "--json", "corner.json", "-q"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const Json figures = Json::parse(read("corner.json"));
  EXPECT_EQ(figures.at("closed"), false);
  EXPECT_EQ(figures.at("euler"), 1);
  const Words shell{"mesh",     "gallery:sphere", "-n",          "200", "-o", "s.ply",
                    "--method", "shell",          "--thickness", "3",   "-q"};
  EXPECT_EQ(run(shell).status, 0);
  EXPECT_EQ(Json::parse(info("s.ply")).at("euler"), 2);
}

TEST_F(Jobs, DexelsGoOutAndComeIn) {
  ASSERT_EQ(run({"mesh", "gallery:torus", "-n", "300", "-o", "a.ply", "--dump-dexels", "a.tdx", "-q"}).status, 0);
  write("scene.json", R"({"difference": [{"dexels": "a.tdx"}, {"implicit": "-x"}]})");
  ASSERT_EQ(run({"mesh", "a.tdx", "-n", "300", "-o", "b.ply", "-q"}).status, 0);
  EXPECT_EQ(Json::parse(info("b.ply")).at("euler"), 0);
  ASSERT_EQ(run({"mesh", "scene.json", "-n", "300", "-o", "c.ply", "-q"}).status, 0);
  EXPECT_EQ(Json::parse(info("c.ply")).at("euler"), 2) << "half a ring";
  EXPECT_NEAR(Json::parse(info("c.ply")).at("volume").get<double>(),
              Json::parse(info("b.ply")).at("volume").get<double>() / 2, 0.05);
}

TEST_F(Jobs, BrokenDexelsAreSaidToBeDexels) {
  const auto says = [&](const std::string& name, const std::string& bytes, const std::string& words) {
    write(name, bytes);
    const Outcome outcome = run({"mesh", name, "-o", "x.ply"});
    EXPECT_EQ(outcome.status, 3);
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  };
  says("a.tdx", "garbage", "error: a.tdx: is no dexel file");
  says("b.tdx", "1 2 3\n4 5 6\n", "error: b.tdx: is no dexel file");
  says("c.tdx", "evenmesh dex", "error: c.tdx: is truncated");
  says("d.tdx", "evenmesh dexels 1\n", "error: d.tdx: is truncated: its header has 96 bytes");
  says("e.bin", "evenmesh dexels 2\n", "error: e.bin: is no dexel file of this version");
  const Outcome outcome = run({"info", "d.tdx"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("d.tdx holds dexels; make a mesh of it first"), std::string::npos) << outcome.err;
}

TEST_F(Jobs, RegularizesTheSolidFirstOnRequest) {
  // Two balls a gap of 0.1 apart.
  Words words{"mesh", "-e", "min((x-0.55)^2, (x+0.55)^2)+y^2+z^2-0.25", "-n", "200", "-o", "m.ply", "-q"};
  ASSERT_EQ(run(words).status, 0);
  EXPECT_EQ(Json::parse(info("m.ply")).at("components"), 2);
  words.insert(words.end(), {"--regularize", "global", "0.15"});
  ASSERT_EQ(run(words).status, 0);
  const Json figures = Json::parse(info("m.ply"));
  expect_sound(figures);
  EXPECT_EQ(figures.at("components"), 1);
  words.back() = "-1";
  EXPECT_EQ(run(words).status, 2);
}

TEST_F(Jobs, RepairsWhatIsBroken) {
  // A tetrahedron of loose triangles, one of them turned, one missing a corner of its own.
  write("loose.stl",
        "solid x\n"
        "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
        "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
        "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
        "facet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid x\n");
  const Outcome outcome = run({"repair", "loose.stl", "-n", "300", "-o", "r.ply"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("1 triangles turned"), std::string::npos) << outcome.err;
  const Json figures = Json::parse(info("r.ply"));
  expect_sound(figures);
  EXPECT_NEAR(figures.at("volume").get<double>(), 1.0 / 6, 0.01);
  EXPECT_EQ(run({"repair", "gallery:sphere", "-o", "x.ply"}).status, 2);
}

TEST_F(Jobs, NamesTheSheetThatItLeavesOut) {
  write("fin.off",
        "OFF\n12 14 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n"
        "0.5 0 0.5\n0.5 1 0.5\n0.5 1 2\n0.5 0 2\n"
        "3 0 2 3\n3 0 3 1\n3 4 5 7\n3 4 7 6\n3 0 1 5\n3 0 5 4\n3 2 6 7\n3 2 7 3\n3 0 4 6\n3 0 6 2\n"
        "3 1 3 7\n3 1 7 5\n3 8 9 10\n3 8 10 11\n");
  for (const char* command : {"mesh", "repair"}) {
    const Outcome outcome = run({command, "fin.off", "-n", "300", "-o", "r.ply"});
    EXPECT_EQ(outcome.status, 4) << outcome.err;
    EXPECT_NE(outcome.err.find("(0.5, 0.5, 1.25); --method shell keeps it"), std::string::npos) << outcome.err;
    expect_sound(Json::parse(info("r.ply")));
  }
}

TEST_F(Jobs, LeavesOutliersOutOnRequest) {
  std::string points;
  for (int i = 0; i < 1000; ++i) {
    const double z = 1 - (i + 0.5) / 500, r = std::sqrt(1 - z * z), turn = 2.39996 * i;
    points +=
        std::to_string(r * std::cos(turn)) + " " + std::to_string(r * std::sin(turn)) + " " + std::to_string(z) + "\n";
  }
  write("ball.xyz", points + "2 2 2\n-2 1 2\n");
  const Outcome outcome = run({"mesh", "ball.xyz", "-n", "200", "-o", "ball.ply", "--outliers", "3"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("2 of 1002 points left out"), std::string::npos) << outcome.err;
  EXPECT_EQ(Json::parse(info("ball.ply")).at("euler"), 2);
}

TEST_F(Jobs, ListsTheGallery) {
  const Outcome text = run({"gallery"});
  EXPECT_EQ(text.status, 0);
  EXPECT_NE(text.out.find("octic"), std::string::npos);
  const Json list = Json::parse(run({"gallery", "--json"}).out);
  ASSERT_GT(list.size(), 10u);
  for (const Json& entry : list) {
    EXPECT_TRUE(entry.contains("name") && entry.contains("euler") && entry.contains("fractal")) << entry;
    EXPECT_NE(text.out.find(entry.at("name").get<std::string>()), std::string::npos);
  }
  EXPECT_EQ(run({"gallery", "sphere", "-n", "60", "-o", "s.off", "--json", "s.json"}).status, 0);
  EXPECT_EQ(Json::parse(read("s.json")).at("euler"), 2);
}

TEST_F(Jobs, ABrokenPromiseIsStatus4AndSaid) {
  // Far too few vertices for a raw fractal: whatever becomes of it, mesh, status and words agree.
  const Outcome outcome = run({"mesh", "gallery:mandelbulb-8", "-n", "100", "-r", "40", "-o", "m.ply", "-q"});
  const bool said = outcome.err.find("promise not kept: ") != std::string::npos;
  EXPECT_EQ(outcome.status, said ? 4 : 0) << outcome.err;
  const Json figures = Json::parse(info("m.ply"));
  if (!said) expect_sound(figures);
}

TEST_F(Jobs, NoProgressBarInAPipeUnlessAsked) {
  EXPECT_EQ(run({"mesh", "gallery:sphere", "-n", "100", "-o", "s.ply"}).err.find('\r'), std::string::npos);
  EXPECT_NE(run({"mesh", "gallery:sphere", "-n", "100", "-o", "s.ply", "--progress", "on"}).err.find('\r'),
            std::string::npos);
}

TEST_F(Jobs, InterruptedItWritesNothing) {
  const Outcome outcome =
      run({"mesh", "gallery:octic", "-n", "2000000", "-o", "x.ply", "--json", "x.json"}, {.signal_after_ms = 300});
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("cancelled"), std::string::npos) << outcome.err;
  EXPECT_EQ(names(), Words{});
}

TEST_F(Jobs, InterruptedWhileItWaitsForInput) {
  const Outcome outcome =
      run({"mesh", "-", "-o", "x.ply"}, {.input = "v 0 0 0\n", .signal_after_ms = 200, .hold_input_open = true});
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_EQ(names(), Words{});
}

}  // namespace
}  // namespace evenmesh::test
