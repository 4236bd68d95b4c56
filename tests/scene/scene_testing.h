#pragma once
/// What the tests of the scene room share.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "evenmesh/error.h"
#include "evenmesh/io.h"
#include "evenmesh/scene.h"
#include "evenmesh/solid.h"

namespace evenmesh::testing_scene {

namespace fs = std::filesystem;

inline fs::path corpus_folder() {
  return fs::path(EVENMESH_SOURCE_DIR) / "tests" / "corpus";
}

/// A folder with a mesh and points in it, gone after the test.
class SceneTest : public testing::Test {
 protected:
  SceneTest() {
    std::string name = (fs::temp_directory_path() / "evenmesh-scene-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder = name;
    write_file(folder / "tetra.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
    write_file(folder / "points.xyz", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n");
  }
  ~SceneTest() override {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }

  Shape json(const std::string& text) const { return parse_scene(text, "scene.json", folder); }
  Shape csg(const std::string& text) const { return parse_scene(text, "scene.csg", folder); }

  /// The message of the error that parsing throws, "" if it does not.
  template <typename Wrong = UnusableInput>
  std::string refusal(const std::string& text, const std::string& name = "scene.json") const {
    try {
      parse_scene(text, name, folder);
    } catch (const Wrong& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder;
};

inline void expect_says(const std::string& message, const std::string& words) {
  EXPECT_NE(message.find(words), std::string::npos) << "'" << message << "' does not say '" << words << "'";
}

inline void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-12) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "axis " << i;
}

inline void expect_box(const Box& box, const Vec3& lo, const Vec3& hi, double tolerance = 1e-12) {
  expect_near(box.lo, lo, tolerance);
  expect_near(box.hi, hi, tolerance);
}

inline double volume(const Mesh& mesh) {
  double six = 0;
  for (const Triangle& t : mesh.triangles) {
    six += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]]));
  }
  return six / 6;
}

/// Closed and oriented: every edge is used as often one way as the other; two-manifold ones once each way.
void expect_closed(const Mesh& mesh, bool manifold = true);

/// Every mesh in it is closed, with finite coordinates and valid indices; returns their number.
std::size_t expect_valid(const Shape& shape);

}  // namespace evenmesh::testing_scene
