/// Whatever is wrong with a file is said in one sentence that names the file.

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/bytes.h"
#include "io_testing.h"

namespace evenmesh::testing_io {
namespace {

std::string read_refusal(const fs::path& path) {
  try {
    read_mesh(path);
  } catch (const UnusableInput& error) {
    return error.what();
  }
  return "";
}

TEST(Errors, OfFiles) {
  const TemporaryFolder folder;
  expect_says(read_refusal(folder / "none.ply"), "none.ply: no such file");
  fs::create_directory(folder / "folder.ply");
  expect_says(read_refusal(folder / "folder.ply"), "folder.ply: is a directory");
  write_file(folder / "empty.ply", "");
  expect_says(read_refusal(folder / "empty.ply"), "empty.ply: is empty");
  write_file(folder / "text.txt", "Nothing of the kind.\n");
  expect_says(read_refusal(folder / "text.txt"), "text.txt: is no file of a mesh or points that can be recognized");
  expect_says(read_refusal(""), "name of the file to read is empty");
}

TEST(Errors, PermissionDenied) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const TemporaryFolder folder;
  write_file(folder / "secret.ply", "ply\n");
  ::chmod((folder / "secret.ply").c_str(), 0);
  expect_says(read_refusal(folder / "secret.ply"), "secret.ply: permission denied");
}

TEST(Errors, OfTextNameTheLine) {
  expect_says(refusal("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99\n", "a.obj"),
              "a.obj: line 4: vertex index 99 is out of range (the file has 3 vertices)");
  expect_says(refusal("v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 0 0 0\n", "a.obj"),
              "a.obj: line 3: vertex index -3 is out of range (before this line there are 2 vertices)");
  expect_says(refusal("v 0 0 0\nv 1,5 0 0\n", "a.obj"),
              "a.obj: line 2: expected a coordinate of the vertex, found '1,5'");
  expect_says(refusal("v 0 0\nf 1 1 1\n", "a.obj"),
              "a.obj: line 1: expected a coordinate of the vertex, found the end of");
  expect_says(refusal("v 0 0 0\nv 0 inf 0\nv 1 1 1\nf 1 2 3\n", "a.obj"),
              "a.obj: holds no triangle whose coordinates are all finite numbers");
  expect_says(refusal("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "a.off"), "a.off: line 6: vertex index 3 is out");
  expect_says(refusal("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "a.off"), "a.off: line 4: expected a coordinate");
  expect_says(refusal("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n", "a.stl"),
              "a.stl: line 4: expected a coord");
  expect_says(refusal("ply\nformat ascii 1.0\nelement vertex many\nend_header\n", "a.ply"), "a.ply: line 3: expected");
  expect_says(refusal("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                      "end_header\n0 0 zero\n",
                      "a.ply"),
              "a.ply: line 8: expected a number, found 'zero'");
}

TEST(Errors, HostileTokensAreShownShortAndPrintable) {
  const std::string message = refusal("v \x1b[31m\x07" + std::string(500, 'x') + " 0 0\n", "a.obj");
  EXPECT_LT(message.size(), 200u);
  for (const char c : message.substr(0, message.find("…"))) EXPECT_TRUE(c >= ' ' && c <= '~');
}

TEST(Errors, WithoutTriangles) {
  expect_says(refusal("v 0 0 0\nv 1 0 0\n", "a.obj"),
              "a.obj: holds no triangles, only 2 points; export the file again");
  for (const MeshFormat format : all_formats) {
    const Mesh points{{{0, 0, 0}, {1, 0, 0}}, {}};
    expect_says(refusal(serialize_mesh(points, format), "points"), "holds no triangles");
    EXPECT_NE(refusal(serialize_mesh({}, format), "nothing"), "");
  }
}

TEST(Errors, HugeCountsAllocateNothing) {
  // Each would need far more memory than there is; the message comes at once because nothing is reserved.
  expect_says(refusal(read_bytes(corpus_folder() / "ply/bad_huge.ply"), "a.ply"), "truncated");
  expect_says(refusal(read_bytes(corpus_folder() / "stl/bad_huge.stl"), "a.stl"), "truncated");
  expect_says(refusal(read_bytes(corpus_folder() / "off/bad_huge.off"), "a.off"), "truncated");
  expect_says(refusal(read_bytes(corpus_folder() / "glb/bad_huge.glb"), "a.glb"), "more than its buffer holds");
  expect_says(refusal(read_bytes(corpus_folder() / "3mf/bad_size.3mf"), "a.3mf"), "would unpack to");
  expect_says(refusal(read_bytes(corpus_folder() / "3mf/bad_bomb.3mf"), "a.3mf"), "far larger than the file");
  expect_says(refusal(read_bytes(corpus_folder() / "glb/bad_bomb.glb"), "a.glb"), "far larger than the file");
}

TEST(Errors, OfContainersSayWhatToDo) {
  const auto say = [](const std::string& file) {
    return refusal(read_bytes(corpus_folder() / file), fs::path(file).filename().string());
  };
  expect_says(say("glb/bad_external.gltf"),
              "in another file, 'tetra.bin', which is not read; save it as one .glb file");
  expect_says(say("glb/bad_draco.glb"), "KHR_draco_mesh_compression");
  expect_says(say("off/bad_binary.off"), "binary OFF is not available");
  expect_says(say("3mf/bad_other_zip.3mf"), "zip archive without a 3D model");
  expect_says(say("3mf/bad_crc.3mf"), "wrong checksum");
}

}  // namespace
}  // namespace evenmesh::testing_io
