/// What the readers make of their formats' forms.

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <bit>

#include "io/bytes.h"
#include "io_testing.h"

namespace evenmesh::testing_io {
namespace {

Mesh from_corpus(const std::string& name) {
  return parse_mesh(read_bytes(corpus_folder() / name), fs::path(name).filename().string());
}

TEST(Read, AllFormsOfOneMeshAreEqual) {
  const Mesh reference = from_corpus("ply/ascii.ply");
  ASSERT_EQ(reference.vertices.size(), 4u);
  ASSERT_EQ(reference.triangles.size(), 4u);
  for (const char* name : {"ply/ascii_crlf.ply", "ply/le.ply",      "ply/be.ply",         "ply/be_double_short.ply",
                           "ply/le_bytes.ply",   "ply/le_crlf.ply", "ply/le_extra.ply",   "ply/le_coloured.ply",
                           "obj/plain.obj",      "obj/colours.obj", "obj/mac.obj",        "off/plain.off",
                           "off/same_line.off",  "off/coff.off",    "off/no_word.off",    "glb/u8.glb",
                           "glb/u16_stride.glb", "glb/u32.glb",     "glb/embedded.gltf",  "3mf/deflated.3mf",
                           "3mf/stored.3mf",     "3mf/zip64.3mf",   "3mf/other_name.3mf", "3mf/production.3mf",
                           "3mf/prefixed.3mf"}) {
    SCOPED_TRACE(name);
    const Mesh mesh = from_corpus(name);
    EXPECT_EQ(mesh.vertices, reference.vertices);
    EXPECT_EQ(mesh.triangles, reference.triangles);
  }
}

TEST(Read, StlCornersAreWelded) {
  for (const char* name : {"stl/ascii.stl", "stl/ascii_upper.stl", "stl/binary.stl", "stl/binary_solid.stl",
                           "stl/binary_trailing.stl", "stl/ascii_two.stl"}) {
    SCOPED_TRACE(name);
    const Mesh mesh = from_corpus(name);
    EXPECT_EQ(mesh.vertices.size(), 4u);
    EXPECT_EQ(mesh.triangles.size(), std::string(name) == "stl/ascii_two.stl" ? 8u : 4u);
  }
}

TEST(Read, MinusZeroIsWeldedToZero) {
  const Mesh mesh = parse_mesh(
      "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
      "facet normal 0 0 0\nouter loop\nvertex -0 0 -0.0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid\n",
      "a.stl");
  EXPECT_EQ(mesh.vertices.size(), 4u);
}

TEST(Read, PolygonsBecomeFans) {
  const std::vector<Triangle> fan{{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(from_corpus("ply/ascii_quads.ply").triangles, fan);
  EXPECT_EQ(from_corpus("obj/continued.obj").triangles, fan);
  EXPECT_EQ(from_corpus("off/noff.off").triangles, fan);
  EXPECT_EQ(from_corpus("glb/fan.glb").triangles, fan);
}

TEST(Read, StripsAlternateTheirOrientation) {
  EXPECT_EQ(from_corpus("glb/strip.glb").triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}}));
  EXPECT_EQ(from_corpus("ply/strips.ply").triangles,
            (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {0, 2, 1}, {1, 2, 3}}));
}

TEST(Read, ObjIndicesCountFromOneOrBack) {
  const Mesh mesh = from_corpus("obj/forms.obj");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}));
  EXPECT_EQ(parse_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 9 9 9\nf -1 -2 -3\n", "a.obj").triangles,
            (std::vector<Triangle>{{0, 1, 2}, {3, 2, 1}}));
}

TEST(Read, MirroringNodesTurnTrianglesSoThatVolumesAdd) {
  const double one = signed_volume(from_corpus("glb/u8.glb"));
  EXPECT_GT(one, 0);
  EXPECT_NEAR(signed_volume(from_corpus("glb/tree.glb")), 9 * one, 1e-6);  // scaled by -2, 2, 2, and once as it is
  EXPECT_NEAR(signed_volume(from_corpus("3mf/components.3mf")), 4 * one, 1e-6);  // two copies under -1, 2, 1
}

TEST(Read, GltfNodesAreRotatedThenMoved) {
  const Mesh mesh = from_corpus("glb/tree.glb");
  // The second child's first vertex: (0,0,0) → matrix (5,0,0) → a quarter turn about z (0,5,0) → (1,7,3).
  const Vec3 p = mesh.vertices[4];
  EXPECT_NEAR(norm(p - Vec3{1, 7, 3}), 0, 1e-6);
}

TEST(Read, UnusedVerticesAndDegenerateTrianglesAreKept) {
  const Mesh mesh = parse_mesh("v 5 5 5\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\nf 2 2 3\n", "a.obj");
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(Read, NumbersOfAnyForm) {
  const Mesh mesh = parse_mesh("v +1 .5 2.\nv 1e-999 -1E+2 0.1e1\nv 1 0 0\nf 1 2 3", "a.obj");
  EXPECT_EQ(mesh.vertices[0], (Vec3{1, 0.5, 2}));
  EXPECT_EQ(mesh.vertices[1], (Vec3{0, -100, 1}));
}

/// Larger than a piece of the parallel reader, with relative indices across pieces.
std::string long_obj(std::size_t triangles, std::size_t wrong_line = 0) {
  std::string text;
  for (std::size_t i = 0; i < triangles; ++i) {
    text += fmt::format("v {} 0 0\nv {} 1 0\nv {} 0 1\n", i, i, i);
    if (4 * i + 4 == wrong_line) {
      text += "f 1 2 99999999\n";
    } else {
      text += i % 2 ? "f -3 -2 -1\n" : fmt::format("f {} {} {}\n", 3 * i + 1, 3 * i + 2, 3 * i + 3);
    }
  }
  return text;
}

TEST(Read, LongObjInPiecesIsTheSameForAnyThreads) {
  const TemporaryFolder folder;
  write_file(folder / "long.obj", long_obj(60'000));
  evenmesh::ExecutionContext one(1), two(2);
  const Mesh a = read_mesh(folder / "long.obj", one), b = read_mesh(folder / "long.obj", two);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(a.triangles.size(), 60'000u);
  for (std::uint32_t i = 0; i < a.triangles.size(); ++i)
    ASSERT_EQ(a.triangles[i], (Triangle{3 * i, 3 * i + 1, 3 * i + 2}));
}

TEST(Read, ErrorsInLongObjNameTheLine) {
  const std::string message = refusal(long_obj(60'000, 200'000), "long.obj");
  EXPECT_TRUE(message.starts_with("long.obj: line 200000: vertex index 99999999 is out of range")) << message;
}

TEST(Read, ByteOrderMarkIsPassedOver) {
  for (const char* name : {"ply/ascii.ply", "obj/plain.obj", "off/plain.off", "stl/ascii.stl", "glb/embedded.gltf"}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(parse_mesh("\xef\xbb\xbf" + read_bytes(corpus_folder() / name), name).triangles,
              from_corpus(name).triangles);
  }
}

TEST(Read, StandardInput) {
  const int kept = ::dup(STDIN_FILENO);
  const int file = ::open((corpus_folder() / "stl/binary.stl").c_str(), O_RDONLY);
  ASSERT_EQ(::dup2(file, STDIN_FILENO), STDIN_FILENO);
  EXPECT_EQ(read_mesh("-").triangles, from_corpus("stl/binary.stl").triangles);
  try {
    read_mesh("-");  // nothing is left
    ADD_FAILURE();
  } catch (const UnusableInput& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("standard input: ")) << error.what();
  }
  ::dup2(kept, STDIN_FILENO);
  ::close(kept);
  ::close(file);
}

TEST(Read, CancelledRunThrows) {
  evenmesh::ExecutionContext context;
  context.cancel();
  EXPECT_THROW(read_mesh(corpus_folder() / "ply/le.ply", context), Cancelled);
}

TEST(Recognize, ByContent) {
  for (const auto& file : corpus_files()) {
    const auto format = format_of_content(read_bytes(file));
    if (!format) continue;
    SCOPED_TRACE(file.filename());
    EXPECT_EQ(format, format_of_name(file.filename().string()));
  }
  EXPECT_EQ(format_of_content("Some text about a surface.\n"), std::nullopt);
  EXPECT_EQ(format_of_content("s is a letter\n"), std::nullopt);
  EXPECT_EQ(format_of_content("1 2 3\n4 5 6\n"), std::nullopt);
  EXPECT_EQ(format_of_content(""), std::nullopt);
}

TEST(Recognize, ByName) {
  EXPECT_EQ(format_of_name("a/b.c/MODEL.STL"), MeshFormat::stl);
  EXPECT_EQ(format_of_name("x.gltf"), MeshFormat::glb);
  EXPECT_EQ(format_of_name("x.3mf"), MeshFormat::threemf);
  EXPECT_EQ(format_of_name("folder.ply/file"), std::nullopt);
  EXPECT_EQ(format_of_name("ply"), std::nullopt);
  EXPECT_EQ(format_of_name(""), std::nullopt);
}

TEST(Read, RealModels) {
  if (!fs::exists(data_folder() / "armadillo.obj")) GTEST_SKIP() << "the real models are not here; set EVENMESH_DATA";
  for (const auto& entry : fs::directory_iterator(data_folder())) {
    if (!format_of_name(entry.path().string())) continue;
    SCOPED_TRACE(entry.path().filename());
    const Mesh mesh = read_mesh(entry.path());
    expect_valid(mesh);
    for (const MeshFormat format : all_formats) {
      const Mesh again = parse_mesh(serialize_mesh(mesh, format), "again");
      EXPECT_EQ(again.triangles.size(), mesh.triangles.size());
      if (format != MeshFormat::stl) {
        EXPECT_EQ(again.triangles, mesh.triangles);
      }
    }
  }
}

}  // namespace
}  // namespace evenmesh::testing_io
