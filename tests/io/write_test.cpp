/// Writers give back what they were given, the same bytes every time; files appear whole or not at all.

#include <sys/stat.h>
#include <unistd.h>

#include <limits>

#include "io/bytes.h"
#include "io_testing.h"

namespace evenmesh::testing_io {
namespace {

TEST(Write, RoundTripInEveryFormat) {
  const Mesh mesh = tetrahedron();
  const TemporaryFolder folder;
  for (std::size_t i = 0; i < std::size(all_formats); ++i) {
    SCOPED_TRACE(extension_of[i]);
    const fs::path path = folder / (std::string("mesh") + extension_of[i]);
    write_mesh(mesh, path);
    EXPECT_EQ(format_of_content(read_bytes(path)), all_formats[i]);
    const Mesh again = read_mesh(path);
    ASSERT_EQ(again.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(again.vertices.size(), mesh.vertices.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(again.vertices[again.triangles[t][k]], mesh.vertices[mesh.triangles[t][k]]);
      }
    }
    EXPECT_EQ(serialize_mesh(mesh, all_formats[i]), read_bytes(path));
  }
}

TEST(Write, CoordinatesComeBackAsTheNearestFloat) {
  const float tiny = std::numeric_limits<float>::denorm_min(), huge = std::numeric_limits<float>::max();
  const Mesh mesh{{{0.1, 1.0 / 3, -1e-7}, {tiny, huge, -huge}, {123456.789, 1e20, 1}}, {{0, 1, 2}}};
  for (const MeshFormat format :
       {MeshFormat::ply, MeshFormat::obj, MeshFormat::off, MeshFormat::threemf, MeshFormat::glb}) {
    const Mesh again = parse_mesh(serialize_mesh(mesh, format), "again");
    ASSERT_EQ(again.vertices.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      for (int a = 0; a < 3; ++a) {
        EXPECT_EQ(static_cast<float>(again.vertices[i][a]), static_cast<float>(mesh.vertices[i][a]));
      }
    }
  }
}

TEST(Write, CoordinatesFarAwayKeepTheirDigits) {
  const Vec3 away{400000.123456789, 5000000.0625, -0.3};
  Mesh mesh = tetrahedron();
  for (Vec3& v : mesh.vertices) v = 0.05 * v + away;
  for (const MeshFormat format : all_formats) {
    SCOPED_TRACE(static_cast<int>(format));
    const std::vector<Vec3> stored = stored_vertices(mesh, format);
    const Mesh again = parse_mesh(serialize_mesh(mesh, format), "again");
    ASSERT_EQ(again.triangles.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &found = again.vertices[again.triangles[t][k]], &given = mesh.vertices[mesh.triangles[t][k]];
        EXPECT_LT(norm(found - given), format == MeshFormat::glb ? 1e-8 : 1e-300);
        EXPECT_EQ(found, stored[mesh.triangles[t][k]]);
      }
  }
}

TEST(Write, RefusesWhatCannotBeReadBack) {
  Mesh mesh = tetrahedron();
  mesh.vertices[1].x = 1e300;
  for (const MeshFormat format : all_formats) EXPECT_THROW(serialize_mesh(mesh, format), InvalidInput);
  mesh = tetrahedron();
  mesh.vertices[1].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(serialize_mesh(mesh, MeshFormat::ply), InvalidInput);
  mesh = tetrahedron();
  mesh.triangles[0][0] = 4;
  EXPECT_THROW(serialize_mesh(mesh, MeshFormat::ply), InvalidInput);
}

TEST(Write, ExtensionDecides) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_mesh(tetrahedron(), folder / "mesh.xyz"), InvalidInput);
  EXPECT_THROW(write_mesh(tetrahedron(), folder / "mesh"), InvalidInput);
  EXPECT_THROW(write_mesh(tetrahedron(), folder / "mesh.gltf"), InvalidInput);
  EXPECT_THROW(write_mesh(tetrahedron(), "-"), InvalidInput);
  EXPECT_EQ(folder.entries(), 0u);
  write_mesh(tetrahedron(), folder / "mesh.data", MeshFormat::off);
  EXPECT_EQ(read_mesh(folder / "mesh.data").triangles, tetrahedron().triangles);
}

TEST(WriteFile, ReplacesAndLeavesNothingBeside) {
  const TemporaryFolder folder;
  write_file(folder / "a", "one");
  write_file(folder / "a", "two");
  EXPECT_EQ(read_bytes(folder / "a"), "two");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(WriteFile, FailureLeavesTheOldFile) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_file(folder / "none/a", "x"), UnusableInput);
  fs::create_directories(folder / "folder/inside");
  EXPECT_THROW(write_file(folder / "folder", "x"), UnusableInput);
  EXPECT_TRUE(fs::exists(folder / "folder/inside"));
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_THROW(write_file("", "x"), InvalidInput);
}

TEST(WriteFile, KeepsPermissionsAndLinks) {
  const TemporaryFolder folder;
  write_file(folder / "a", "one");
  ::chmod((folder / "a").c_str(), 0640);
  fs::create_symlink("a", folder / "link");
  fs::create_symlink("later", folder / "dangling");
  write_file(folder / "link", "two");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_bytes(folder / "a"), "two");
  struct stat status {};
  ASSERT_EQ(::stat((folder / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640u);
  write_file(folder / "dangling", "three");
  EXPECT_EQ(read_bytes(folder / "later"), "three");
  EXPECT_TRUE(fs::is_symlink(folder / "dangling"));
}

TEST(WriteFile, FollowsTheUmask) {
  const TemporaryFolder folder;
  const mode_t before = ::umask(027);
  write_file(folder / "a", "x");
  ::umask(before);
  struct stat status {};
  ASSERT_EQ(::stat((folder / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640u);
}

TEST(WriteFile, DevicesAreWrittenTo) {
  write_file("/dev/null", "x");
  EXPECT_FALSE(fs::is_regular_file("/dev/null"));
}

TEST(WriteFile, FullDiskIsSaid) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  try {
    write_mesh(tetrahedron(), "/dev/full", MeshFormat::ply);
    ADD_FAILURE();
  } catch (const UnusableInput& error) {
    EXPECT_NE(std::string(error.what()).find("the disk is full"), std::string::npos) << error.what();
  }
}

TEST(WriteFile, PipesAreWrittenTo) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  write_file("/dev/fd/" + std::to_string(ends[1]), "through a pipe");
  ::close(ends[1]);
  EXPECT_EQ(read_bytes("/dev/fd/" + std::to_string(ends[0])), "through a pipe");
  ::close(ends[0]);
}

}  // namespace
}  // namespace evenmesh::testing_io
