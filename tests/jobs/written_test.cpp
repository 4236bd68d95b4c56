#include "evenmesh/written.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "evenmesh/measure.h"
#include "geometry/primitives.h"

namespace evenmesh {
namespace {

bool has(const MeshResult& result, FindingCode code) {
  return std::any_of(result.report.findings.begin(), result.report.findings.end(),
                     [code](const Finding& f) { return f.code == code; });
}

MeshResult box_at(const Vec3& place, double size) {
  MeshResult result{make_box_around({place, place + size * Vec3{1, 1, 1}}), {}};
  result.report.quality = measure_quality(result.mesh);
  return result;
}

TEST(Written, IsTheResultWhereTheFileHoldsIt) {
  for (const MeshFormat format : {MeshFormat::ply, MeshFormat::stl, MeshFormat::glb}) {
    const MeshResult near = as_written(box_at({}, 1), format);
    EXPECT_TRUE(near.report.findings.empty());
    const MeshResult given = box_at({400000, 800000, 0}, 0.01), far = as_written(given, format);
    EXPECT_EQ(far.mesh.vertices, given.mesh.vertices);
    EXPECT_FALSE(has(far, FindingCode::coordinates_rounded));
    EXPECT_EQ(has(far, FindingCode::stl_as_text), format == MeshFormat::stl);
  }
}

TEST(Written, FiguresAreThoseOfTheFileWhereItRounds) {
  MeshResult given = box_at({}, 1e-4);
  const Mesh other = make_box_around({{1e5, 1e5, 1e5}, {1e5 + 1e-4, 1e5 + 1e-4, 1e5 + 1e-4}});
  const auto first = static_cast<std::uint32_t>(given.mesh.vertices.size());
  given.mesh.vertices.insert(given.mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Triangle& t : other.triangles) given.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  given.report.quality = measure_quality(given.mesh);
  EXPECT_FALSE(has(as_written(given, MeshFormat::ply), FindingCode::coordinates_rounded));
  const MeshResult glb = as_written(given, MeshFormat::glb);
  EXPECT_TRUE(has(glb, FindingCode::coordinates_rounded));
  EXPECT_TRUE(has(glb, FindingCode::no_area)) << "a broken promise, so that the program ends with 4";
  EXPECT_EQ(glb.report.quality.degenerate_faces, measure_quality(glb.mesh).degenerate_faces);
  EXPECT_NE(glb.mesh.vertices, given.mesh.vertices);
}

}  // namespace
}  // namespace evenmesh
