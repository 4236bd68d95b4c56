#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "grid/coarsen.h"
#include "grid/sample_checks.h"

namespace evenmesh {
namespace {

std::filesystem::path data_file(const std::string& name) {
  if (const char* folder = std::getenv("EVENMESH_DATA")) return std::filesystem::path(folder) / name;
  return std::filesystem::path(EVENMESH_SOURCE_DIR) / ".." / "shared" / "data" / name;
}

void add_polygon(Mesh& mesh, const std::vector<std::uint32_t>& corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

Mesh read_obj(std::istream& in) {
  Mesh mesh;
  for (std::string line, word; std::getline(in, line);) {
    std::istringstream words(line);
    words >> word;
    if (word == "v") {
      Vec3 p;
      words >> p.x >> p.y >> p.z;
      mesh.vertices.push_back(p);
    } else if (word == "f") {
      std::vector<std::uint32_t> corners;
      while (words >> word) corners.push_back(static_cast<std::uint32_t>(std::stoul(word)) - 1);
      add_polygon(mesh, corners);
    }
  }
  return mesh;
}

Mesh read_off(std::istream& in) {
  Mesh mesh;
  std::string word;
  std::size_t vertices = 0, faces = 0, edges = 0;
  in >> word >> vertices >> faces >> edges;
  mesh.vertices.resize(vertices);
  for (Vec3& p : mesh.vertices) in >> p.x >> p.y >> p.z;
  for (std::size_t f = 0; f < faces; ++f) {
    std::size_t n = 0;
    in >> n;
    std::vector<std::uint32_t> corners(n);
    for (std::uint32_t& c : corners) in >> c;
    add_polygon(mesh, corners);
    std::getline(in, word);
  }
  return mesh;
}

class SampleData : public testing::TestWithParam<const char*> {};

TEST_P(SampleData, ClosedModelsKeepTheirVolumeAndNeedNoVote) {
  const std::filesystem::path path = data_file(GetParam());
  std::ifstream in(path);
  if (!in) GTEST_SKIP() << path << " is not there: set EVENMESH_DATA to the folder of the test models";
  const Mesh mesh = path.extension() == ".obj" ? read_obj(in) : read_off(in);
  double volume = 0, area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    volume += dot(a, cross(b, c)) / 6;
    area += 0.5 * norm(cross(b - a, c - a));
  }
  const SampleSet set = sampled(mesh, 256, 2);
  EXPECT_EQ(set.disagreements, 0u);
  // Overlapping parts of a model count once here, and twice in the volume of the mesh.
  EXPECT_NEAR(volume_of(set, expect_one_sign_grid(set)), std::abs(volume), 0.01 * std::abs(volume));
  EXPECT_NEAR(set.total_area, area, 0.02 * area);
  EXPECT_NEAR(coarsen(set).total_area, set.total_area, 0.02 * set.total_area);
}

INSTANTIATE_TEST_SUITE_P(Models, SampleData,
                         testing::Values("armadillo.obj", "fertility.off", "rocker-arm.obj", "spot.obj",
                                         "fandisk.off"));

}  // namespace
}  // namespace evenmesh
