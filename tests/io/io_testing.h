#pragma once
/// What the tests of the io room share.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/random.h"
#include "evenmesh/error.h"
#include "evenmesh/io.h"

namespace evenmesh::testing_io {

namespace fs = std::filesystem;

inline fs::path corpus_folder() {
  return fs::path(EVENMESH_SOURCE_DIR) / "tests" / "corpus";
}

/// The corpus of meshes, or that of points, in one order on every machine.
inline std::vector<fs::path> corpus_files(bool points = false) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(corpus_folder())) {
    if (!entry.is_regular_file() || entry.path().extension() == ".py") continue;
    const fs::path kind = entry.path().parent_path().filename();
    if (kind != "scene" && kind != "glsl_source" && (kind == "points") == points) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// A folder that is gone after the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "evenmesh-io-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  fs::path operator/(const std::string& name) const { return path_ / name; }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path_), fs::directory_iterator()));
  }

 private:
  fs::path path_;
};

/// Four vertices that float holds exactly.
inline Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.25}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

inline double signed_volume(const Mesh& mesh) {
  double six = 0;
  for (const Triangle& t : mesh.triangles) {
    six += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]]));
  }
  return six / 6;
}

/// The message of the UnusableInput that parsing throws, or "" if it does not.
inline std::string refusal(const std::string& bytes, const std::string& name) {
  try {
    parse_mesh(bytes, name);
  } catch (const UnusableInput& error) {
    return error.what();
  }
  return "";
}

/// The same for points.
inline std::string point_refusal(const std::string& bytes, const std::string& name) {
  try {
    parse_points(bytes, name);
  } catch (const UnusableInput& error) {
    return error.what();
  }
  return "";
}

inline void expect_says(const std::string& message, const std::string& words) {
  EXPECT_NE(message.find(words), std::string::npos) << "'" << message << "' does not say '" << words << "'";
}

inline void expect_valid(const PointCloud& cloud) {
  EXPECT_FALSE(cloud.points.empty());
  for (const Vec3& p : cloud.points) ASSERT_TRUE(is_finite(p));
  for (const Vec3& n : cloud.normals) ASSERT_TRUE(is_finite(n));
  ASSERT_TRUE(cloud.normals.empty() || cloud.normals.size() == cloud.points.size());
}

inline void expect_valid(const Mesh& mesh) {
  EXPECT_FALSE(mesh.triangles.empty());
  for (const Vec3& v : mesh.vertices) ASSERT_TRUE(is_finite(v));
  for (const Triangle& t : mesh.triangles) {
    for (const auto v : t) ASSERT_LT(v, mesh.vertices.size());
  }
}

/// A few random edits: flipped bits, lost bytes, hostile words, pieces of other files.
std::string mutate(std::string bytes, const std::vector<std::string>& others, Random& random);

inline fs::path data_folder() {
  if (const char* folder = std::getenv("EVENMESH_DATA")) return folder;
  return fs::path(EVENMESH_SOURCE_DIR) / ".." / "shared" / "data";
}

constexpr MeshFormat all_formats[] = {MeshFormat::ply, MeshFormat::obj, MeshFormat::stl,
                                      MeshFormat::off, MeshFormat::glb, MeshFormat::threemf};
constexpr const char* extension_of[] = {".ply", ".obj", ".stl", ".off", ".glb", ".3mf"};

}  // namespace evenmesh::testing_io
