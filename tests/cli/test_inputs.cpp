/// What the program says of inputs it reads only in part, and of units.

#include <cmath>
#include <nlohmann/json.hpp>

#include "program.h"

namespace evenmesh::test {
namespace {

using Inputs = ProgramTest;
using Json = nlohmann::json;

/// A box of 1 × 1 × 1 in a scene of that unit; meshed to 3MF it is a file in it.
std::string scene_in(const std::string& unit) {
  return R"({"units": ")" + unit + R"(", "transform": {"scale": 0.5}, "of": {"gallery": "cube"}})";
}

double length_of(const std::string& info) {
  return std::cbrt(Json::parse(info).at("volume").get<double>());
}

TEST_F(Inputs, UnitsAreKeptConvertedAndSaid) {
  write("in.json", scene_in("in"));
  ASSERT_EQ(run({"mesh", "in.json", "-n", "200", "-o", "in.3mf", "-q"}).status, 0);
  EXPECT_EQ(Json::parse(info("in.3mf")).at("unit"), "in");
  const double inch = length_of(info("in.3mf"));

  Outcome outcome = run({"repair", "in.3mf", "-n", "200", "-o", "again.3mf"});
  EXPECT_EQ(Json::parse(info("again.3mf")).at("unit"), "in");
  EXPECT_EQ(outcome.err.find("unit"), std::string::npos) << outcome.err;

  outcome = run({"mesh", "in.3mf", "-n", "200", "-o", "in.stl", "--json", "run.json"});
  EXPECT_NE(outcome.err.find("STL files have no place for a unit: the coordinates stay in inches"), std::string::npos);
  EXPECT_NE(read("run.json").find("unit-lost"), std::string::npos);
  EXPECT_NEAR(length_of(info("in.stl")), inch, 1e-3);

  outcome = run({"mesh", "in.3mf", "-n", "200", "--unit", "mm", "-o", "mm.stl"});
  EXPECT_NE(outcome.err.find("from inches to millimeters"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("no place"), std::string::npos) << outcome.err;
  EXPECT_NEAR(length_of(info("mm.stl")), 25.4 * inch, 0.03);

  outcome = run({"compare", "in.3mf", "in.3mf"});
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Inputs, AUnitMayBeGivenWhereNoneIsKnown) {
  write("a.obj", tetrahedron_obj);
  ASSERT_EQ(run({"mesh", "a.obj", "-n", "100", "-o", "none.3mf", "-q"}).status, 0);
  EXPECT_EQ(Json::parse(info("none.3mf")).at("unit"), "mm");
  ASSERT_EQ(run({"mesh", "a.obj", "-n", "100", "--unit", "inch", "-o", "inch.3mf", "-q"}).status, 0);
  EXPECT_EQ(Json::parse(info("inch.3mf")).at("unit"), "in");
  EXPECT_NEAR(length_of(info("none.3mf")), length_of(info("inch.3mf")), 1e-9);
  const Outcome wrong = run({"mesh", "a.obj", "--unit", "parsec", "-o", "x.ply"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("--unit takes one of micron, mm"), std::string::npos) << wrong.err;
}

TEST_F(Inputs, OperandsGetTheUnitOfTheFirst) {
  write("in.json", scene_in("in"));
  write("mm.json", scene_in("mm"));
  const Outcome outcome = run({"boolean", "union", "in.json", "mm.json", "-n", "300", "-o", "both.3mf"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("mm.json: lengths are converted from millimeters to inches"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(Json::parse(info("both.3mf")).at("unit"), "in");
}

TEST_F(Inputs, WhatIsLeftOutIsSaid) {
  write("nan.obj", std::string(tetrahedron_obj) + "v nan 0 0\nf 5 1 2\n");
  const Outcome outcome = run({"mesh", "nan.obj", "-n", "100", "-o", "x.ply"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(
      outcome.err.find("nan.obj: 1 vertex whose coordinates are not finite numbers was left out, with the triangle "
                       "at it"),
      std::string::npos)
      << outcome.err;
  EXPECT_NE(run({"info", "nan.obj"}).err.find("left out"), std::string::npos);
  EXPECT_EQ(run({"mesh", "nan.obj", "-n", "100", "-o", "x.ply", "-q"}).err, "");
}

TEST_F(Inputs, TitlesOfColumnsAreSkipped) {
  std::string rows = "x,y,z\n";
  for (int i = 0; i < 400; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 400, r = std::sqrt(1 - z * z), u = 2.399963 * i;
    rows += std::to_string(r * std::cos(u)) + "," + std::to_string(r * std::sin(u)) + "," + std::to_string(z) + "\n";
  }
  write("ball.csv", rows);
  const Outcome outcome = run({"mesh", "ball.csv", "-n", "150", "-o", "x.ply"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("line 1, 'x,y,z', holds titles"), std::string::npos) << outcome.err;
  EXPECT_EQ(Json::parse(info("ball.csv")).at("points"), 400);
}

TEST_F(Inputs, AnOpenSheetCannotBeOffset) {
  write("sheet.obj", "v 0 0 0\nv 4 0 0\nv 4 2 0.5\nv 0 2 0\nf 1 2 3 4\n");
  const Outcome outcome = run({"offset", "sheet.obj", "--distance", "0.1", "-o", "x.ply"});
  EXPECT_EQ(outcome.status, 3);
  for (const char* words : {"sheet", "no inside", "about 0.2 thick", "evenmesh wrap sheet.obj -r 40"})
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace evenmesh::test
