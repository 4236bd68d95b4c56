/// Polygons become triangles that cover them and nothing else.

#include <fmt/format.h>

#include "io_testing.h"

namespace evenmesh::testing_io {
namespace {

constexpr const char* notched = "v 4 0 0\nv 4 1 0\nv 1 1 0\nv 1 4 0\nv 0 4 0\nv 0 0 0\n";

double area_of(const std::string& text, const char* name) {
  const Mesh mesh = parse_mesh(text, name);
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    area += 0.5 * norm(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
  }
  return area;
}

std::vector<Finding> findings_of(const std::string& text, const char* name) {
  return parse_mesh_or_points(text, name).findings;
}

TEST(Polygons, NotchesStayOpen) {
  EXPECT_DOUBLE_EQ(area_of(std::string(notched) + "f 1 2 3 4 5 6\n", "a.obj"), 7);
  EXPECT_DOUBLE_EQ(area_of(std::string(notched) + "f -1 -2 -3 -4 -5 -6\n", "a.obj"), 7) << "the other way round";
  EXPECT_DOUBLE_EQ(area_of("OFF\n6 1 0\n4 0 0\n4 1 0\n1 1 0\n1 4 0\n0 4 0\n0 0 0\n6 0 1 2 3 4 5\n", "a.off"), 7);
  EXPECT_DOUBLE_EQ(area_of("ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                           "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                           "4 0 0\n4 1 0\n1 1 0\n1 4 0\n0 4 0\n0 0 0\n6 0 1 2 3 4 5\n",
                           "a.ply"),
                   7);
}

TEST(Polygons, TrianglesFaceAsTheirPolygon) {
  // Every corner in turn is the first, in a plane across all axes.
  for (int first = 0; first < 6; ++first)
    for (const bool turned : {false, true}) {
      std::string text = "v 4 0 4\nv 4 1 5\nv 1 1 2\nv 1 4 5\nv 0 4 4\nv 0 0 0\nf";
      for (int i = 0; i < 6; ++i) text += fmt::format(" {}", (first + (turned ? 6 - i : i)) % 6 + 1);
      const Mesh mesh = parse_mesh(text + "\n", "a.obj");
      ASSERT_EQ(mesh.triangles.size(), 4u);
      double area = 0;
      for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        const double z = cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a).z;
        EXPECT_EQ(z < 0, turned);
        area += 0.5 * std::abs(z);
      }
      EXPECT_NEAR(area, 7, 1e-12);
    }
}

TEST(Polygons, ConvexOnesStayFans) {
  const Mesh mesh = parse_mesh("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0.1\nv 0 2 0\nf 1 2 3 4 5\n", "a.obj");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Polygons, OfOtherPiecesOfAnObjFile) {
  std::string text = notched;
  while (text.size() < (3u << 20)) text += "# a line to fill a piece of the file\n";
  text += "v 0 0 5\nv 1 0 5\nv 0 1 5\nf 1 2 3 4 5 6\nf 7 8 9\n";
  EXPECT_DOUBLE_EQ(area_of(text, "a.obj"), 7.5);
}

TEST(Polygons, ThatCrossThemselvesAreSaid) {
  const std::string star = "v 10 0 0\nv -8 6 0\nv 3 -9 0\nv 3 9 0\nv -8 -6 0\nf 1 2 3 4 5\n";
  const std::vector<Finding> findings = findings_of(star, "a.obj");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, FindingCode::polygons_not_simple);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  EXPECT_TRUE(findings_of(std::string(notched) + "f 1 2 3 4 5 6\n", "a.obj").empty());
}

TEST(Polygons, OfManyCornersEnd) {
  // A comb of 20,000 teeth, and a walk that crosses itself everywhere.
  std::string comb = "v 0 0 0\nv 20000 0 0\n", face = "f 1 2", knot, walk = "f";
  for (int i = 20'000; i > 0; --i) comb += fmt::format("v {} {} 0\n", i, i % 2 == 0 ? 9 : 1);
  for (int i = 0; i < 20'000; ++i) face += fmt::format(" {}", i + 3);
  for (int i = 0; i < 4'000; ++i) knot += fmt::format("v {} {} 0\n", i * 7919 % 4001, i * 104729 % 3989);
  for (int i = 0; i < 4'000; ++i) walk += fmt::format(" {}", i + 1);
  EXPECT_NEAR(area_of(comb + face + "\n", "a.obj"), 1e5, 3e4);
  EXPECT_EQ(findings_of(knot + walk + "\n", "a.obj").size(), 1u);
}

TEST(NotFinite, VerticesGoWithTheirTriangles) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 1 1 0\nv 0 1e999 0\nf 1 2 3\nf 1 2 4\nf 2 5 3\nf 4 6 1\n";
  const FileContents contents = parse_mesh_or_points(text, "a.obj");
  const Mesh& mesh = std::get<Mesh>(contents.what);
  expect_valid(mesh);
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
  ASSERT_EQ(contents.findings.size(), 1u);
  EXPECT_EQ(contents.findings[0].sentence,
            "a.obj: 2 vertices whose coordinates are not finite numbers were left out, with 2 triangles");
}

TEST(NotFinite, PointsGoWithTheirNormals) {
  const FileContents contents = parse_mesh_or_points("0 0 0 0 0 1\nnan 0 0 1 0 0\n1 0 0 0 1 0\n", "a.xyz");
  const PointCloud& cloud = std::get<PointCloud>(contents.what);
  EXPECT_EQ(cloud.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(cloud.normals, (std::vector<Vec3>{{0, 0, 1}, {0, 1, 0}}));
  ASSERT_EQ(contents.findings.size(), 1u);
  EXPECT_EQ(contents.findings[0].sentence, "a.xyz: 1 point whose coordinates are not finite numbers was left out");
}

TEST(NotFinite, TrianglesOfStl) {
  Mesh mesh = tetrahedron();
  std::string bytes = serialize_mesh(mesh, MeshFormat::stl);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + 84 + 12, &nan, 4);
  const FileContents contents = parse_mesh_or_points(bytes, "a.stl");
  EXPECT_EQ(std::get<Mesh>(contents.what).triangles.size(), 3u);
  EXPECT_EQ(contents.findings.size(), 1u);
}

}  // namespace
}  // namespace evenmesh::testing_io
