/// Point clouds: every form gives the same points, every defect a sentence.

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <variant>

#include "io/bytes.h"
#include "io_testing.h"

namespace evenmesh::testing_io {
namespace {

const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<Vec3> corner_normals{{-0.6, -0.8, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

void expect_near(const std::vector<Vec3>& got, const std::vector<Vec3>& wanted) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_LT(norm(got[i] - wanted[i]), 1e-7) << i;  // files hold floats
}

TEST(Points, AllFormsOfOneCloudAreEqual) {
  const auto files = corpus_files(true);
  ASSERT_GT(files.size(), 40u);
  for (const auto& file : files) {
    const std::string name = file.filename().string();
    if (name.starts_with("bad_")) continue;
    SCOPED_TRACE(name);
    const PointCloud cloud = parse_points(read_bytes(file), name);
    EXPECT_EQ(cloud.points, corners);
    if (name.find("normals") == std::string::npos) {
      EXPECT_TRUE(cloud.normals.empty());
    } else if (name.starts_with("nan_normals")) {
      ASSERT_EQ(cloud.normals.size(), 4u);
      EXPECT_EQ(cloud.normals[0], Vec3{}) << "unknown";
      EXPECT_EQ(cloud.normals[1], corner_normals[1]);
    } else {
      expect_near(cloud.normals, corner_normals);
    }
    EXPECT_EQ(cloud.bounds(), (Box{{0, 0, 0}, {1, 1, 1}}));
  }
}

TEST(Points, BadFilesAreRefusedByNameInOneSentence) {
  for (const auto& file : corpus_files(true)) {
    const std::string name = file.filename().string(), bytes = read_bytes(file);
    SCOPED_TRACE(name);
    if (name != "bad_mesh.ply") {
      EXPECT_NE(refusal(bytes, name), "") << "points are no mesh";
    }
    if (!name.starts_with("bad_")) continue;
    const std::string message = point_refusal(bytes, name);
    EXPECT_TRUE(message.starts_with(name + ": ")) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_LT(message.size(), 200u);
  }
}

TEST(Points, MeshesAreRefused) {
  for (const auto& file : corpus_files()) {
    SCOPED_TRACE(file.filename());
    if (file.stem() == "bad_points" && file.extension() != ".glb") continue;  // bad meshes, but good points
    EXPECT_NE(point_refusal(read_bytes(file), file.filename().string()), "");
  }
  EXPECT_EQ(parse_points(read_bytes(corpus_folder() / "ply/bad_points.ply"), "a.ply").points, corners);
}

TEST(Points, ContentWinsOverAWrongExtension) {
  for (const char* file : {"plain.xyz", "tabs_normals.xyz", "count.pts", "blocks_normals.pwn", "le_normals.ply"}) {
    const std::string bytes = read_bytes(corpus_folder() / "points" / file);
    for (const char* name : {"a.xyz", "a.pts", "a.ply", "a.obj", "a.stl", "a.3mf", "a.txt", "a"}) {
      SCOPED_TRACE(std::string(file) + " as " + name);
      EXPECT_EQ(parse_points(bytes, name).points, corners);
    }
  }
  EXPECT_EQ(parse_mesh(read_bytes(corpus_folder() / "obj/plain.obj"), "a.xyz").triangles.size(), 4u);
  EXPECT_EQ(parse_mesh(read_bytes(corpus_folder() / "off/no_word.off"), "a.off").triangles.size(), 4u);
  EXPECT_EQ(parse_points("\xef\xbb\xbf"
                         "1 2 3\n",
                         "a.txt")
                .points,
            (std::vector<Vec3>{{1, 2, 3}}));
}

TEST(Points, ErrorsNameTheLineAndSayWhatToDo) {
  expect_says(point_refusal("0 0 0\n1 one 0\n", "a.xyz"),
              "a.xyz: line 2: expected a coordinate of the point, found 'one'");
  expect_says(point_refusal("0 0 0 a\n", "a.xyz"), "line 1: expected a number, found 'a'");
  expect_says(point_refusal("0 0 0\n\n# c\n1 2 3 4\n5 6 7\n", "a.xyz"),
              "line 4: has 4 columns, but the first point has 3; correct it");
  expect_says(point_refusal("0 0 0\n1 2 3\n5 6", "a.xyz"),
              "line 3: has 2 columns, but the first point has 3; the file is");
  expect_says(point_refusal("1 2\n", "a.xyz"), "line 1: a point needs three coordinates, this line holds 2 numbers");
  expect_says(point_refusal("0 nan 0\n-inf 0 0\n", "a.xyz"), "holds no point whose coordinates are all finite numbers");
  expect_says(
      point_refusal("1,5 2,5 3,5\n", "a.xyz"),
      "line 1: its numbers stand apart by commas and by blanks; use one of them, and write decimal numbers with a "
      "point");
  expect_says(point_refusal("x;y;z\n1,5;2,5;3,5\n", "a.csv"), "line 2: its numbers stand apart by commas and by semi");
  expect_says(point_refusal("x,y,z,of\n1,2,3,house\n", "a.csv"), "line 2: expected a number, found 'house'");
  expect_says(point_refusal("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", "a.msh"), "is no file of a mesh or points");
  expect_says(point_refusal("1,5;2,5;3,5\n", "a.xyz"), "line 1: its numbers stand apart by commas and by semicolons");
  expect_says(point_refusal("1, 2, 3 house\n", "a.xyz"), "line 1: expected a number, found 'house'");
  expect_says(point_refusal("x y z\nO 0 0\n", "a.xyz"), "line 1: expected a coordinate of the point, found 'x'");
  expect_says(point_refusal("5\n0 0 0\n", "a.pts"), "announces 5 points, but only 1 follow; the file is truncated");
  expect_says(point_refusal("1\n0 0 0\n1 1 1\n2 2 2\n", "a.pts"), "announces 1 points, but 3 lines follow");
  expect_says(point_refusal("2\n0 0 0\n1 1 1\n", "a.pwn"), "holds 2 points, but their normals do not follow");
  expect_says(point_refusal("7\n", "a.pts"), "holds no points");
  expect_says(point_refusal("", "a.pts"), "is empty");
  expect_says(point_refusal("words of no kind", "a.txt"), "is no file of a mesh or points that can be recognized");
  expect_says(point_refusal(read_bytes(corpus_folder() / "points/bad_mesh.ply"), "a.ply"), "holds a mesh, not points");
  expect_says(refusal("0 0 0\n1 1 1\n", "a.xyz"), "a.xyz: holds no triangles, only 2 points");
}

TEST(Points, ColumnsAreNormalsWhereTheyHaveUnitLength) {
  const auto with_normals = [](std::size_t unit, std::size_t other) {
    std::string text;
    for (std::size_t i = 0; i < unit; ++i) text += fmt::format("{} 0 0 0 0.6 0.8\n", i);
    for (std::size_t i = 0; i < other; ++i) text += fmt::format("{} 1 0 3 2 1\n", i);
    return !parse_points(text, "a.xyz").normals.empty();
  };
  EXPECT_TRUE(with_normals(1, 0));
  EXPECT_TRUE(with_normals(99, 1));
  EXPECT_FALSE(with_normals(98, 2));
  EXPECT_FALSE(with_normals(0, 1));
  EXPECT_FALSE(parse_points("1 2 3 0 0 5\n", "a.xyz").points.empty());
  EXPECT_EQ(parse_points("1\n1 2 3 0 0 5\n", "a.PWN").normals, (std::vector<Vec3>{{0, 0, 5}}));
  EXPECT_EQ(parse_points("1\n1 2 3\n0 0 5\n", "a.pts").normals, (std::vector<Vec3>{{0, 0, 5}}));
}

/// Larger than several pieces of the parallel reader.
std::string long_text(std::size_t points, std::size_t wrong_line = 0) {
  std::string text = fmt::format("{}\n", points);
  for (std::size_t i = 0; i < points; ++i) {
    text += i + 2 == wrong_line ? "1 2 3 4\n" : fmt::format("{} {} 0.25 0 -1 0\n", i, 0.5 * static_cast<double>(i));
  }
  return text;
}

TEST(Points, LongTextInPiecesIsTheSameForAnyThreads) {
  const TemporaryFolder folder;
  write_file(folder / "long.pwn", long_text(150'000));
  evenmesh::ExecutionContext one(1), two(2);
  const PointCloud a = read_points(folder / "long.pwn", one), b = read_points(folder / "long.pwn", two);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.normals, b.normals);
  ASSERT_EQ(a.points.size(), 150'000u);
  ASSERT_EQ(a.normals.size(), 150'000u);
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    ASSERT_EQ(a.points[i], (Vec3{static_cast<double>(i), 0.5 * static_cast<double>(i), 0.25}));
    ASSERT_EQ(a.normals[i], (Vec3{0, -1, 0}));
  }
  expect_says(point_refusal(long_text(150'000, 140'000), "a.pwn"), "a.pwn: line 140000: has 4 columns");
}

TEST(Points, FilesAndStreams) {
  const TemporaryFolder folder;
  const auto message = [](const fs::path& path) {
    try {
      read_points(path);
    } catch (const UnusableInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  expect_says(message(folder / "none.xyz"), "none.xyz: no such file");
  fs::create_directory(folder / "folder.xyz");
  expect_says(message(folder / "folder.xyz"), "folder.xyz: is a directory");

  const int kept = ::dup(STDIN_FILENO);
  const int file = ::open((corpus_folder() / "points/count.pts").c_str(), O_RDONLY);
  ASSERT_EQ(::dup2(file, STDIN_FILENO), STDIN_FILENO);
  EXPECT_EQ(read_points("-").points, corners);
  expect_says(message("-"), "standard input: is empty");
  ::dup2(kept, STDIN_FILENO);
  ::close(kept);
  ::close(file);

  evenmesh::ExecutionContext context;
  context.cancel();
  EXPECT_THROW(read_points(corpus_folder() / "points/count.pts", context), Cancelled);
}

TEST(Points, OneCallReadsWhateverAFileHolds) {
  EXPECT_TRUE(std::holds_alternative<Mesh>(read_mesh_or_points(corpus_folder() / "ply/le.ply").what));
  EXPECT_TRUE(std::holds_alternative<PointCloud>(read_mesh_or_points(corpus_folder() / "points/le_normals.ply").what));
  EXPECT_TRUE(std::holds_alternative<PointCloud>(read_mesh_or_points(corpus_folder() / "points/plain.xyz").what));
  EXPECT_THROW(read_mesh_or_points(corpus_folder() / "glb/bad_points.glb"), UnusableInput);
}

TEST(Points, TruncatedFilesNeverHarm) {
  for (const auto& file : corpus_files(true)) {
    SCOPED_TRACE(file.filename());
    const std::string bytes = read_bytes(file);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      // A copy of that size, so that a sanitizer sees a byte read behind it.
      const std::vector<char> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      try {
        expect_valid(parse_points({cut.data(), cut.size()}, file.filename().string()));
      } catch (const UnusableInput&) {
      }
    }
  }
}

TEST(Points, MutatedFilesGiveValidPointsOrASentence) {
  std::vector<std::string> all;
  const auto files = corpus_files(true);
  for (const auto& file : files) all.push_back(read_bytes(file));
  std::erase(all, "");
  Random random(20240603);
  std::size_t parsed = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (int round = 0; round < 300; ++round) {
      const std::string text = mutate(all[i], all, random);
      const std::vector<char> bytes(text.begin(), text.end());
      for (const char* name : {"a.xyz", "a.pwn", "a.ply"}) {
        try {
          expect_valid(parse_points({bytes.data(), bytes.size()}, name));
          ++parsed;
        } catch (const UnusableInput& error) {
          ASSERT_GT(std::string(error.what()).size(), 10u);
        }
      }
      ASSERT_FALSE(::testing::Test::HasFatalFailure());
    }
  }
  EXPECT_GT(parsed, 0u);  // otherwise the mutations would be too coarse to get anywhere
}

TEST(Points, RealClouds) {
  if (!fs::exists(data_folder() / "kitten.xyz")) GTEST_SKIP() << "the real clouds are not here; set EVENMESH_DATA";
  const PointCloud kitten = read_points(data_folder() / "kitten.xyz");
  expect_valid(kitten);
  EXPECT_EQ(kitten.points.size(), 5210u);
  EXPECT_EQ(kitten.normals.size(), 5210u);
  const PointCloud bunny = read_points(data_folder() / "bunny-scan.pts");
  expect_valid(bunny);
  EXPECT_EQ(bunny.points.size(), 30571u);
  EXPECT_TRUE(bunny.normals.empty());
}

}  // namespace
}  // namespace evenmesh::testing_io
