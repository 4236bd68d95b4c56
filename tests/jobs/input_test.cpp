#include "evenmesh/input.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "evenmesh/dexels.h"
#include "evenmesh/error.h"
#include "evenmesh/io.h"

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
