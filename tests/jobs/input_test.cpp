#include "evenmesh/input.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "evenmesh/dexels.h"
#include "evenmesh/error.h"
#include "evenmesh/io.h"
#include "evenmesh/mesh_shape.h"
#include "evenmesh/solid.h"

namespace evenmesh {
namespace {

constexpr const char* tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
constexpr const char* shader = "float map(vec3 p) { return length(p) - 0.5; }\n";
constexpr const char* scene = R"({"difference": [{"gallery": "cube"}, {"gallery": "sphere"}]})";
constexpr const char* points = "0 0 0\n1 0 0\n0 1 0\n";

std::string dexels() {
  using Crossing = Dexels::Crossing;
  Dexels one{.origin = {}, .spacing = 1, .size = {3, 3, 3}, .crossings = {}};
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    Crossing enters{.point = {1, 1, 1}, .axis = axis, .t = 0.5f};
    Crossing leaves = enters;
    enters.point[axis] = 0;
    leaves.leaves = true;
    one.crossings.push_back(enters);
    one.crossings.push_back(leaves);
  }
  return serialize_dexels(one);
}

class Inputs : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("evenmesh-inputs-" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "-" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path.string();
  }

  std::filesystem::path folder_;
};

/// A tetrahedron with edges of one inch.
std::string inches() {
  return serialize_mesh(
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, LengthUnit::inch},
      MeshFormat::threemf);
}

TEST_F(Inputs, KeepTheirUnit) {
  const Shape shape = parse_shape(inches(), "a.3mf");
  EXPECT_EQ(shape.unit, LengthUnit::inch);
  const Shape same = in_one_unit({shape})[0], millimeters = in_one_unit({shape}, LengthUnit::millimeter)[0];
  EXPECT_EQ(same.bounds.hi, (Vec3{1, 1, 1}));
  EXPECT_EQ(millimeters.bounds.hi, (Vec3{25.4, 25.4, 25.4}));
  EXPECT_EQ(millimeters.unit, LengthUnit::millimeter);
  ASSERT_EQ(millimeters.findings.size(), 1u);
  EXPECT_EQ(millimeters.findings[0].code, FindingCode::unit_converted);
}

TEST_F(Inputs, OfSeveralUnitsGetThatOfTheFirst) {
  const Shape unknown = parse_shape(tetrahedron, "a.obj"), inch = parse_shape(inches(), "a.3mf");
  const Shape meter = converted(inch, LengthUnit::meter);
  const std::vector<Shape> shapes = in_one_unit({unknown, inch, meter});
  for (const Shape& shape : shapes) {
    EXPECT_EQ(shape.unit, LengthUnit::inch);
    EXPECT_LT(norm(shape.bounds.hi - Vec3{1, 1, 1}), 1e-15);
  }
  EXPECT_FALSE(in_one_unit({unknown})[0].unit) << "nobody knows";
}

TEST_F(Inputs, ScenesConvertMeshesThatKnowTheirUnit) {
  file("a.3mf", inches());
  file("a.obj", tetrahedron);
  const Shape shape = read_shape(file("a.json", R"({"units": "mm", "union": [{"mesh": "a.3mf"}, {"mesh": "a.obj"}]})"));
  EXPECT_EQ(shape.unit, LengthUnit::millimeter);
  EXPECT_EQ(shape.bounds.hi, (Vec3{25.4, 25.4, 25.4}));
  EXPECT_EQ(shape.findings.size(), 1u);
  EXPECT_EQ(read_shape(file("b.json", R"({"mesh": "a.3mf"})")).unit, LengthUnit::inch);
  EXPECT_FALSE(read_shape(file("c.json", R"({"mesh": "a.obj"})")).unit);
}

TEST_F(Inputs, UnitsAndFindingsOfReadingReachTheResult) {
  std::string text = tetrahedron;
  text += "v nan 0 0\nf 5 1 2\n";
  Shape shape = parse_shape(text, "a.obj");
  shape.unit = LengthUnit::foot;
  const Shape grown = offset(shape, 0.1);
  const MeshResult result = mesh_shape(grown, {.vertices = 200});
  EXPECT_EQ(result.mesh.unit, LengthUnit::foot);
  ASSERT_FALSE(result.report.findings.empty());
  EXPECT_EQ(result.report.findings[0].code, FindingCode::vertices_not_finite);
}

TEST_F(Inputs, AreRecognizedByContentAndName) {
  EXPECT_EQ(kind_of_input("gallery:octic"), InputKind::built_in);
  EXPECT_EQ(kind_of_input("-"), InputKind::standard_input);
  EXPECT_EQ(kind_of_input(file("a.obj", tetrahedron)), InputKind::mesh_or_points);
  EXPECT_EQ(kind_of_input(file("a.txt", points)), InputKind::mesh_or_points);
  EXPECT_EQ(kind_of_input(file("a.txt", scene)), InputKind::scene);
  EXPECT_EQ(kind_of_input(file("a.csg", "cube();")), InputKind::scene);
  EXPECT_EQ(kind_of_input(file("a.txt", shader)), InputKind::shader);
  EXPECT_EQ(kind_of_input(file("a.frag", "// anything")), InputKind::shader);
  EXPECT_EQ(kind_of_input(file("a.bin", dexels())), InputKind::dexels);
  EXPECT_EQ(kind_of_input(file("a.tdx", "garbage")), InputKind::dexels);
  EXPECT_EQ(kind_of_input(file("a.NII.gz", "1 2 3")), InputKind::volume);
  EXPECT_EQ(kind_of_input(file("a.vdb", "ply\nformat ascii 1.0\n")), InputKind::mesh_or_points) << "by its content";
  EXPECT_EQ(kind_of_input("missing.vdb"), InputKind::mesh_or_points) << "whoever reads it says that it is missing";
  const std::string misleading = R"x({"name": "vec3 float map(vec3 p)", "implicit": "1"})x";
  EXPECT_EQ(kind_of_input(file("s.json", misleading)), InputKind::scene);
}

TEST_F(Inputs, BecomeShapes) {
  EXPECT_TRUE(read_shape("gallery:octic").field());
  EXPECT_TRUE(read_shape(file("a.obj", tetrahedron)).mesh());
  EXPECT_TRUE(read_shape(file("a.xyz", points)).points());
  EXPECT_TRUE(read_shape(file("a.json", scene)).compound());
  EXPECT_NO_THROW(read_shape(file("a.tdx", dexels())));
  EXPECT_EQ(read_shape(file("a.obj", tetrahedron)).name, (folder_ / "a.obj").string());
}

TEST_F(Inputs, InMemoryAreTheSame) {
  EXPECT_TRUE(parse_shape(tetrahedron, "a.obj").mesh());
  EXPECT_TRUE(parse_shape(tetrahedron, "-").mesh());
  EXPECT_TRUE(parse_shape(points, "-").points());
  EXPECT_TRUE(parse_shape(scene, "-").compound());
  EXPECT_NO_THROW(parse_shape(dexels(), "-"));
  EXPECT_EQ(parse_shape(points, "-").name, "standard input");
  file("part.obj", tetrahedron);
  EXPECT_NO_THROW(parse_shape(R"({"mesh": "part.obj"})", "-", {}, folder_)) << "paths start from the folder";
}

TEST_F(Inputs, ThatAreWrongAreSaidToBe) {
  EXPECT_THROW(read_shape("gallery:spere"), InvalidInput);
  EXPECT_THROW(read_shape((folder_ / "missing.obj").string()), UnusableInput);
  EXPECT_THROW(read_shape(folder_.string()), UnusableInput);
  EXPECT_THROW(read_shape(""), UnusableInput);
  EXPECT_THROW(parse_shape("", "-"), UnusableInput);
  EXPECT_THROW(parse_shape(std::string(300, '\xfe'), "a.json"), UnusableInput);
  try {
    read_shape(file("a.nrrd", "NRRD0004\n"));
    FAIL() << "volumes are not available";
  } catch (const NotAvailable& error) {
    EXPECT_EQ(error.what(),
              "reading an NRRD volume (" + (folder_ / "a.nrrd").string() + ") is not available in this version");
  }
}

TEST_F(Inputs, StopWhenCancelled) {
  ExecutionContext context;
  context.cancel();
  EXPECT_THROW(read_shape(file("a.json", scene), {}, context), Cancelled);
}

}  // namespace
}  // namespace evenmesh
