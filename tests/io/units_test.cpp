/// Units of length: read, written, and said where they get lost.

#include "evenmesh/units.h"

#include "io_testing.h"

namespace evenmesh::testing_io {
namespace {

constexpr LengthUnit all_units[] = {LengthUnit::micron, LengthUnit::millimeter, LengthUnit::centimeter,
                                    LengthUnit::meter,  LengthUnit::inch,       LengthUnit::foot};

Mesh tetrahedron_in(std::optional<LengthUnit> unit) {
  Mesh mesh = tetrahedron();
  mesh.unit = unit;
  return mesh;
}

Mesh there_and_back(const Mesh& mesh, MeshFormat format) {
  return parse_mesh(serialize_mesh(mesh, format), "x");
}

TEST(Units, ConvertExactly) {
  EXPECT_EQ(conversion_factor(LengthUnit::inch, LengthUnit::millimeter), 25.4);
  EXPECT_EQ(conversion_factor(LengthUnit::foot, LengthUnit::inch), 12);
  EXPECT_EQ(conversion_factor(LengthUnit::millimeter, LengthUnit::meter), 0.001);
  for (const LengthUnit unit : all_units) {
    EXPECT_EQ(conversion_factor(unit, unit), 1);
    EXPECT_EQ(unit_of_name(word_of(unit)), unit);
    EXPECT_EQ(unit_of_name(abbreviation_of(unit)), unit);
  }
  EXPECT_FALSE(unit_of_name("MM"));
  EXPECT_FALSE(unit_of_name(""));
}

TEST(Units, ThreeMfKeepsThem) {
  for (const LengthUnit unit : all_units) {
    const Mesh mesh = tetrahedron_in(unit), back = there_and_back(mesh, MeshFormat::threemf);
    EXPECT_EQ(back.unit, unit);
    EXPECT_EQ(back.vertices, mesh.vertices);
    EXPECT_FALSE(unit_remark(mesh, MeshFormat::threemf));
  }
  EXPECT_EQ(there_and_back(tetrahedron(), MeshFormat::threemf).unit, LengthUnit::millimeter);
}

TEST(Units, GlbIsInMeters) {
  const Mesh mesh = tetrahedron_in(LengthUnit::inch), back = there_and_back(mesh, MeshFormat::glb);
  EXPECT_EQ(back.unit, LengthUnit::meter);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    EXPECT_LT(norm(back.vertices[v] - 0.0254 * mesh.vertices[v]), 1e-15);
  EXPECT_EQ(there_and_back(tetrahedron(), MeshFormat::glb).vertices, tetrahedron().vertices);
  ASSERT_TRUE(unit_remark(mesh, MeshFormat::glb));
  EXPECT_EQ(unit_remark(mesh, MeshFormat::glb)->code, FindingCode::unit_converted);
}

TEST(Units, AreSaidWhereAFormatLosesThem) {
  const auto code = [](LengthUnit unit, MeshFormat format) -> std::optional<FindingCode> {
    const auto remark = unit_remark(tetrahedron_in(unit), format);
    if (!remark) return {};
    return remark->code;
  };
  for (const MeshFormat format : {MeshFormat::stl, MeshFormat::obj, MeshFormat::ply, MeshFormat::off}) {
    EXPECT_EQ(code(LengthUnit::inch, format), FindingCode::unit_lost);
    EXPECT_EQ(code(LengthUnit::millimeter, format), std::nullopt) << "as everybody takes it";
    EXPECT_FALSE(unit_remark(tetrahedron(), format)) << "not known";
  }
  EXPECT_EQ(code(LengthUnit::meter, MeshFormat::stl), FindingCode::unit_lost);
  EXPECT_EQ(code(LengthUnit::meter, MeshFormat::ply), std::nullopt);
  EXPECT_EQ(code(LengthUnit::meter, MeshFormat::glb), std::nullopt);
}

TEST(Units, SupportsOfThreeMfAreLeftOut) {
  const FileContents contents = read_mesh_or_points(corpus_folder() / "3mf/support.3mf");
  EXPECT_EQ(std::get<Mesh>(contents.what).triangles.size(), 4u);
  EXPECT_EQ(std::get<Mesh>(contents.what).unit, LengthUnit::inch);
  ASSERT_EQ(contents.findings.size(), 1u);
  EXPECT_EQ(contents.findings[0].code, FindingCode::objects_left_out);
}

}  // namespace
}  // namespace evenmesh::testing_io
