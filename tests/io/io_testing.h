#pragma once
/// What the tests of the io room share.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "evenmesh/error.h"
#include "evenmesh/io.h"

namespace evenmesh::testing_io {

namespace fs = std::filesystem;

inline fs::path corpus_folder() {
  return fs::path(EVENMESH_SOURCE_DIR) / "tests" / "corpus";
}

/// The corpus in one order on every machine.
inline std::vector<fs::path> corpus_files() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(corpus_folder())) {
    if (entry.is_regular_file() && entry.path().extension() != ".py") files.push_back(entry.path());
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

inline void expect_valid(const Mesh& mesh) {
  EXPECT_FALSE(mesh.triangles.empty());
  for (const Vec3& v : mesh.vertices) ASSERT_TRUE(is_finite(v));
  for (const Triangle& t : mesh.triangles) {
    for (const auto v : t) ASSERT_LT(v, mesh.vertices.size());
  }
}

constexpr MeshFormat all_formats[] = {MeshFormat::ply, MeshFormat::obj, MeshFormat::stl,
                                      MeshFormat::off, MeshFormat::glb, MeshFormat::threemf};
constexpr const char* extension_of[] = {".ply", ".obj", ".stl", ".off", ".glb", ".3mf"};

}  // namespace evenmesh::testing_io
