#pragma once
/// Drives the program from outside, as a shell would.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace evenmesh::test {

struct Outcome {
  int status = -1;  ///< exit status; 128 + signal when a signal ended it
  std::string out, err;
};

struct Spawn {
  std::filesystem::path program = EVENMESH_PROGRAM;
  std::string input{};           ///< bytes for standard input
  int signal_after_ms = -1;      ///< send SIGINT after that long; -1: never
  bool hold_input_open = false;  ///< standard input never ends
};

/// Runs the program in `folder` and waits for it.
Outcome run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                    const Spawn& spawn = {});

/// A fresh folder for every test.
class ProgramTest : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  Outcome run(const std::vector<std::string>& arguments, const Spawn& spawn = {}) const {
    return run_program(arguments, folder, spawn);
  }
  /// Writes a file into the folder.
  void write(const std::string& name, const std::string& bytes) const;
  std::string read(const std::string& name) const;
  /// Names of everything in the folder, sorted.
  std::vector<std::string> names() const;
  /// `info --json` of a file in the folder, as text.
  std::string info(const std::string& name) const;

  std::filesystem::path folder;
};

/// A tetrahedron as an OBJ file.
inline constexpr const char* tetrahedron_obj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

/// Two points with normals as a PLY file.
inline constexpr const char* points_ply =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\nend_header\n0 0 0 0 0 1\n0 3 4 0 1 0\n";

}  // namespace evenmesh::test
