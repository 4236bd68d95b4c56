#pragma once
/// Shapes of the gallery in whatever form, from end to end.

#include <cstddef>
#include <ostream>
#include <string>

#include "grid/sample_checks.h"
#include "pipeline/pipeline_testing.h"
#include "shape/forms.h"

namespace evenmesh::testing {

/// A shape of the gallery that any method meshes as it should.
struct Easy {
  Form form;
  const char* name;
  std::size_t vertices;
  friend void PrintTo(const Easy& easy, std::ostream* out) {
    *out << easy.name << ", " << easy.form.name << ", " << easy.vertices << " vertices";
  }
};

inline std::string name_of_easy(const ::testing::TestParamInfo<Easy>& info) {
  std::string name = info.param.form.name + std::string("_") + info.param.name;
  std::erase(name, '-');
  return name;
}

class EasyShape : public ::testing::TestWithParam<Easy> {};

TEST_P(EasyShape, MeetsItsCountAndItsTopology) {
  const auto& [form, name, vertices] = GetParam();
  const Shape shape = gallery_shape(name);
  const MeshResult result = meshed(form(shape), {.vertices = vertices, .quality = Quality::fast});
  expect_good_mesh(result);
  const double asked = static_cast<double>(vertices);
  EXPECT_NEAR(static_cast<double>(result.mesh.vertices.size()), asked, 1e-3 * asked);
  EXPECT_EQ(result.report.regularization_rounds, 0u) << "nothing here is finer than the grid";
  for (const GalleryEntry& entry : gallery())
    if (entry.name == name && entry.euler) {
      EXPECT_EQ(result.report.quality.euler, *entry.euler);
    }
  const double area = sampled(shape, 128).total_area;
  EXPECT_NEAR(result.report.quality.area, area, 0.02 * area);
}

}  // namespace evenmesh::testing
