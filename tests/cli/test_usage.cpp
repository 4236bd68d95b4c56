/// Help, and what the program says to wrong command lines and unreadable inputs.

#include <fstream>

#include "program.h"

namespace evenmesh::test {
namespace {

using Usage = ProgramTest;
using Words = std::vector<std::string>;

/// One sentence on standard error, nothing on standard output, no stack of exceptions.
void expect_one_sentence(const Outcome& outcome, const std::string& fragment) {
  EXPECT_TRUE(outcome.err.starts_with("error: ")) << outcome.err;
  EXPECT_NE(outcome.err.find(fragment), std::string::npos) << "no '" << fragment << "' in: " << outcome.err;
  EXPECT_EQ(outcome.err.find("internal"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.out, "");
}

const std::vector<std::string> all_commands{"mesh",   "info",   "compare", "gallery", "render", "boolean",
                                            "offset", "repair", "wrap",    "track",   "advect", "mill"};

/// A reader copies them.
TEST_F(Usage, ExpressionsOfTheReadmeAreMeshed) {
  std::ifstream file(std::string(EVENMESH_SOURCE_DIR) + "/README.md");
  ASSERT_TRUE(file);
  std::size_t found = 0;
  for (std::string line; std::getline(file, line);) {
    const std::size_t at = line.find("mesh -e '");
    if (at == std::string::npos) continue;
    const std::size_t from = at + 9, to = line.find('\'', from);
    const Outcome outcome = run({"mesh", "-e", line.substr(from, to - from), "-n", "300", "-o", "x.ply"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    ++found;
  }
  EXPECT_GT(found, 0u);
}

TEST_F(Usage, HelpListsEveryCommand) {
  const Outcome outcome = run({"--help"});
  EXPECT_EQ(outcome.status, 0);
  for (const std::string& command : all_commands) {
    EXPECT_NE(outcome.out.find("\n  " + command + " "), std::string::npos) << command;
    EXPECT_EQ(run({command, "--help"}).status, 0) << command;
  }
}

TEST_F(Usage, HelpOfMeshDescribesEveryOptionOnce) {
  const std::string help = run({"mesh", "--help"}).out;
  for (const char* option :
       {"--output",          "--vertices",    "--edge-length", "--error",    "--method",    "--resolution",
        "--thickness",       "--bounds",      "--quality",     "--evenness", "--optimizer", "--iterations",
        "--tolerance",       "--start",       "--seed",        "--connect",  "--topology",  "--features",
        "--density",         "--threads",     "--backend",     "--report",   "--json",      "--quiet",
        "--verbose",         "--progress",    "--expression",  "--define",   "--entry",     "--raster",
        "--raster-vertices", "--dump-dexels", "--dump-shell",  "--outliers", "--placement", "--max-cycle",
        "--format",          "--unit"}) {
    const std::size_t first = help.find(std::string(option) + " ");
    ASSERT_TRUE(first != std::string::npos || help.find(std::string(option) + "\n") != std::string::npos) << option;
  }
}

TEST_F(Usage, SaysItsVersion) {
  const Outcome outcome = run({"--version"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(outcome.out.starts_with("evenmesh ")) << outcome.out;
}

TEST_F(Usage, NoCommandPrintsHelpAsAnError) {
  const Outcome outcome = run({});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("mesh"), std::string::npos);
}

struct Case {
  Words words;
  std::string fragment;
};

TEST_F(Usage, WrongUsageIsStatus2) {
  write("a.obj", tetrahedron_obj);
  write("s.json", R"({"mesh": "a.obj"})");
  write("p.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  std::filesystem::create_directory(folder / "folder");
  const std::string in = "gallery:sphere";
  const std::vector<Case> cases{
      {{"knead"}, "no command 'knead'"},
      {{"mesh"}, "no input"},
      {{"mesh", "-o", "x.ply"}, "no input"},
      {{"mesh", in}, "no output"},
      {{"mesh", in, "a.obj", "-o", "x.ply"}, "2 inputs"},
      {{"mesh", in, "-e", "x", "-o", "x.ply"}, "2 inputs"},
      {{"mesh", "-e", "x", "-e", "y", "-o", "x.ply"}, "2 inputs"},
      {{"mesh", in, "-o", "x.ply", "--frobnicate"}, "--frobnicate"},
      {{"mesh", in, "-o"}, "--output"},
      {{"mesh", in, "-o", "x.txt"}, "extension"},
      {{"mesh", in, "-o", "nowhere/x.ply"}, "no folder 'nowhere'"},
      {{"mesh", in, "-o", "folder"}, "folder"},
      {{"mesh", in, "-o", "folder.ply", "--json", "nowhere/x.json"}, "no folder 'nowhere'"},
      {{"mesh", in, "-o", "-", "--json", "-"}, "standard output"},
      {{"mesh", in, "-o", "x.ply", "--format", "doc"}, "--format"},
      {{"mesh", in, "-o", "x.ply", "-n", "20,000"}, "20000"},
      {{"mesh", in, "-o", "x.ply", "-n", "many"}, "whole number"},
      {{"mesh", in, "-o", "x.ply", "-n", "3"}, "between 4 and 1000000000"},
      {{"mesh", in, "-o", "x.ply", "-n", "-5"}, "whole number"},
      {{"mesh", in, "-o", "x.ply", "-n", "99999999999999999999999"}, "out of range"},
      {{"mesh", in, "-o", "x.ply", "-n", "1e4"}, "whole number"},
      {{"mesh", in, "-o", "x.ply", "-n", "100", "-l", "0.1"}, "-l"},
      {{"mesh", in, "-o", "x.ply", "-l", "0"}, "above 0"},
      {{"mesh", in, "-o", "x.ply", "-l", "nan"}, "number"},
      {{"mesh", in, "-o", "x.ply", "-r", "7"}, "between 8 and 8192"},
      {{"mesh", in, "-o", "x.ply", "-j", "2000"}, "-j"},
      {{"mesh", in, "-o", "x.ply", "--tolerance", "1"}, "--tolerance"},
      {{"mesh", in, "-o", "x.ply", "--evenness", "1.5"}, "--evenness"},
      {{"mesh", in, "-o", "x.ply", "--iterations", "10001"}, "--iterations"},
      {{"mesh", in, "-o", "x.ply", "--quality", "best"}, "fast, normal, high"},
      {{"mesh", in, "-o", "x.ply", "--method", "shells"}, "auto, raster, shell"},
      {{"mesh", in, "-o", "x.ply", "--thickness", "21"}, "between 1 and 20"},
      {{"mesh", in, "-o", "x.ply", "--outliers", "-1"}, "--outliers"},
      {{"mesh", in, "-o", "x.ply", "--outliers", "3"}, "--outliers is for points"},
      {{"mesh", in, "-o", "x.ply", "--start", "cold"}, "--start"},
      {{"mesh", in, "-o", "x.ply", "--connect", "glue"}, "complex, flood, fragments"},
      {{"mesh", in, "-o", "x.ply", "--connect", "fragments", "--max-cycle", "9"}, "between 3 and 8"},
      {{"mesh", in, "-o", "x.ply", "--max-cycle", "5"}, "--connect fragments"},
      {{"mesh", in, "-o", "x.ply", "--topology", "any"}, "keep, simplify"},
      {{"mesh", in, "-o", "x.ply", "--seed", "-1"}, "--seed"},
      {{"mesh", in, "-o", "x.ply", "--bounds", "0,0,0,1,1"}, "6 numbers"},
      {{"mesh", in, "-o", "x.ply", "--bounds", "0,0,0,1,0,1"}, "y0 below y1"},
      {{"mesh", in, "-o", "x.ply", "--bounds", "0,0,0,1,inf,1"}, "number"},
      {{"mesh", in, "-o", "x.ply", "--progress", "maybe"}, "--progress"},
      {{"mesh", in, "-o", "x.ply", "-q", "-v"}, "-q and -v"},
      {{"mesh", in, "-o", "x.ply", "-D", "a=1"}, "-D"},
      {{"mesh", "--raster", "default", "-o", "x.ply"}, "--raster"},
      {{"mesh", "--raster", "default", "default", "-o", "x.ply"}, "nothing to draw"},
      {{"mesh", "--raster", "default", "default", "a.obj", "a.obj", "-o", "x.ply"}, "one mesh"},
      {{"mesh", "--raster", "default", "default", "a.obj", "-e", "x", "-o", "x.ply"}, "no expression"},
      {{"mesh", "--raster", "default", "default", "a.obj", "--raster-vertices", "6", "-o", "x.ply"}, "one of them"},
      {{"mesh", "--raster", "-", "-", "a.obj", "-o", "x.ply"}, "standard input"},
      {{"mesh", "a.obj", "--raster-vertices", "6", "-o", "x.ply"}, "--raster-vertices"},
      {{"mesh", "--raster", "default", "default", in, "-o", "x.ply"}, "takes a mesh file"},
      {{"mesh", "-e", "x", "-D", "a", "-o", "x.ply"}, "name=value"},
      {{"mesh", "-e", "x^2+(", "-o", "x.ply"}, "column"},
      {{"mesh", "-e", "a*x", "-o", "x.ply"}, "column"},
      {{"mesh", "gallery:spere", "-o", "x.ply"}, "sphere"},
      {{"gallery", "spere", "-o", "x.ply"}, "sphere"},
      {{"gallery", "sphere"}, "no output"},
      {{"gallery", "-o", "x.ply"}, "NAME"},
      {{"info"}, "MESH"},
      {{"info", in}, "mesh file"},
      {{"info", "s.json"}, "s.json is a scene"},
      {{"boolean", "-o", "x.ply"}, "OPERATION"},
      {{"boolean", "sum", in, in, "-o", "x.ply"}, "union, intersection, difference"},
      {{"boolean", "union", in, "-o", "x.ply"}, "1 input where 2 or more"},
      {{"boolean", "union", "-o", "x.ply"}, "no input"},
      {{"boolean", "union", "-", "-", "-o", "x.ply"}, "standard input"},
      {{"boolean", "difference", in, "p.xyz", "-o", "x.ply"}, "is a point cloud and has no inside"},
      {{"boolean", "union", in, in}, "no output"},
      {{"offset", in, "-o", "x.ply"}, "--distance, --closing, --opening"},
      {{"offset", in, "--distance", "1", "--closing", "1", "-o", "x.ply"}, "exclude each other"},
      {{"offset", in, "--distance", "far", "-o", "x.ply"}, "--distance"},
      {{"offset", in, "--opening", "-1", "-o", "x.ply"}, "above 0"},
      {{"offset", in, in, "--distance", "1", "-o", "x.ply"}, "2 inputs"},
      {{"compare", "a.obj"}, "B"},
      {{"compare", "a.obj", "a.obj", "--samples", "0"}, "--samples"},
      {{"render", "a.obj"}, "no output"},
      {{"render", "a.obj", "-o", "x.png", "--width", "8"}, "--width"},
      {{"render", "a.obj", "-o", "x.png", "--view", "north"}, "--view"},
      {{"render", "a.obj", "-o", "x.png", "--up", "x"}, "--up"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(testing::PrintToString(c.words));
    const Outcome outcome = run(c.words);
    EXPECT_EQ(outcome.status, 2);
    expect_one_sentence(outcome, c.fragment);
  }
  EXPECT_EQ(names(), (Words{"a.obj", "folder", "p.xyz", "s.json"})) << "a wrong command line leaves nothing behind";
}

TEST_F(Usage, WhatIsNotBuiltYetIsStatus2AndNeverIgnored) {
  write("a.obj", tetrahedron_obj);
  for (const char* name : {"s.vdb", "s.nii", "s.nii.gz", "s.nrrd"}) {
    write(name, "1 2 3\n");
    const Outcome outcome = run({"mesh", name, "-o", "x.ply"});
    EXPECT_EQ(outcome.status, 2) << name;
    expect_one_sentence(outcome, "not available in this version");
  }
  const std::vector<Words> options{
      {"--density", "curvature"},
      {"--error", "0.001"},
  };
  for (const Words& option : options) {
    SCOPED_TRACE(testing::PrintToString(option));
    Words words{"mesh", "gallery:sphere", "-o", "x.ply"};
    words.insert(words.end(), option.begin(), option.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 2);
    expect_one_sentence(outcome, "not available in this version");
  }
  for (const char* command : {"track", "advect", "mill"}) {
    const Outcome outcome = run({command, "a.obj", "--distance", "1", "-o", "x.ply"});
    EXPECT_EQ(outcome.status, 2) << command;
    expect_one_sentence(outcome, "not available in this version");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "x.ply"));
}

TEST_F(Usage, WrongScenesAreStatus3AndSayWhere) {
  write("axis.json", R"({"transform": {"rotate": {"axis": [0,0,0], "degrees": 9}}, "of": {"gallery": "sphere"}})");
  write("file.json", R"({"union": [{"mesh": "none.stl"}]})");
  write("text.json", "1 2 3\n");
  write("sum.csg", "group() {\n minkowski() { cube(); }\n}\n");
  const std::vector<std::pair<const char*, const char*>> cases{
      {"axis.json", "axis.json: transform.rotate.axis: needs three numbers, not all zero"},
      {"file.json", "file.json: union[0].mesh: there is no file 'none.stl'"},
      {"text.json", "text.json: line 1, column 3: this is no JSON"},
      {"sum.csg", "sum.csg: line 2, column 2: the OpenSCAD node 'minkowski' is not supported"},
      {"missing.json", "missing.json: no such file"},
  };
  for (const auto& [name, words] : cases) {
    const Outcome outcome = run({"mesh", name, "-o", "x.ply"});
    EXPECT_EQ(outcome.status, 3) << name;
    expect_one_sentence(outcome, words);
  }
}

TEST_F(Usage, UnreadableInputIsStatus3) {
  write("empty.obj", "");
  write("garbage.stl", "these bytes are no mesh of any kind");
  write("binary.ply", std::string(300, '\xfe'));
  write("truncated.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n");
  write("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99\n");
  write("huge.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
        "property float y\nproperty float z\nend_header\n");
  write("word.xyz", "0 0 0\n1 one 0\n");
  write("count.pts", "9\n0 0 0\n1 1 1\n");
  write("faceless.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n");
  std::filesystem::create_directory(folder / "folder.obj");
  for (const char* name : {"missing.obj", "missing.xyz", "empty.obj", "garbage.stl", "binary.ply", "truncated.off",
                           "nan.obj", "index.obj", "huge.ply", "word.xyz", "count.pts", "faceless.obj", "folder.obj"}) {
    SCOPED_TRACE(name);
    const Outcome meshed = run({"mesh", name, "-o", "x.ply"});
    EXPECT_EQ(meshed.status, 3);
    expect_one_sentence(meshed, name);
    EXPECT_EQ(run({"info", name}).status, 3);
    EXPECT_EQ(run({"render", name, "-o", "x.png"}).status, 3);
  }
  EXPECT_EQ(run({"mesh", "-", "-o", "x.ply"}).status, 3) << "empty standard input";
  EXPECT_FALSE(std::filesystem::exists(folder / "x.ply"));
  EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
}

TEST_F(Usage, AShapeWithoutSurfaceIsStatus3) {
  for (const Words& input : {Words{"-e", "x^2+y^2+z^2+1"}, Words{"-e", "x^2+y^2+z^2-1", "--bounds", "3,3,3,4,4,4"}}) {
    Words words{"mesh", "-n", "100", "-o", "x.ply"};
    words.insert(words.end(), input.begin(), input.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 3) << outcome.err;
    EXPECT_EQ(names(), Words{});
  }
}

TEST_F(Usage, WithoutTheOpenVdbPluginNoShellIsPromised) {
  std::filesystem::create_directory(folder / "alone");
  const std::filesystem::path program = folder / "alone" / "evenmesh";
  std::filesystem::copy_file(EVENMESH_PROGRAM, program);
  const Words words{"mesh", "gallery:sphere", "-n", "100", "--method", "shell", "-o", "x.ply", "--dump-shell", "x.vdb"};
  const Outcome outcome = run(words, {.program = program});
  EXPECT_EQ(outcome.status, 2);
  expect_one_sentence(outcome, "apt install libopenvdb-dev libboost-dev");
  EXPECT_EQ(names(), Words{"alone"}) << "it is said before the work is done";
}

}  // namespace
}  // namespace evenmesh::test
