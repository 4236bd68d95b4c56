/// Every scene of the corpus, and thousands of their mutations, either gives a valid shape or a sentence.

#include <algorithm>
#include <map>
#include <vector>

#include "core/random.h"
#include "io/bytes.h"
#include "scene_testing.h"

namespace evenmesh::testing_scene {

void expect_closed(const Mesh& mesh, bool manifold) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++uses[{t[i], t[(i + 1) % 3]}];
  }
  for (const auto& [edge, count] : uses) {
    const auto back = uses.find({edge.second, edge.first});
    ASSERT_TRUE(back != uses.end() && back->second == count) << "edge " << edge.first << " " << edge.second;
    if (manifold) {
      EXPECT_EQ(count, 1) << "edge " << edge.first << " " << edge.second;
    }
  }
}

std::size_t expect_valid(const Shape& shape) {
  std::size_t meshes = 0;
  if (const Compound* compound = shape.compound()) {
    EXPECT_FALSE(compound->operands.empty());
    for (const Shape& operand : compound->operands) meshes += expect_valid(operand);
  }
  if (const Mesh* mesh = shape.mesh()) {
    ++meshes;
    for (const Vec3& v : mesh->vertices) EXPECT_TRUE(is_finite(v));
    for (const Triangle& t : mesh->triangles) {
      for (const auto v : t) EXPECT_LT(v, mesh->vertices.size());
    }
  }
  return meshes;
}

namespace {

std::vector<fs::path> corpus_files() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(corpus_folder() / "scene")) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

bool is_bad(const fs::path& file) {
  return file.filename().string().starts_with("bad_");
}

TEST(SceneCorpus, GoodFilesAreReadAndBadOnesAreRefusedByName) {
  const auto files = corpus_files();
  ASSERT_GT(files.size(), 15u);
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename());
    std::string message;
    try {
      expect_valid(read_scene(file));
    } catch (const UnusableInput& error) {
      message = error.what();
    }
    EXPECT_EQ(is_bad(file), !message.empty()) << message;
    if (is_bad(file)) {
      EXPECT_TRUE(message.starts_with(file.string() + ": ")) << message;
    }
  }
}

std::string mutate(std::string bytes, const std::vector<std::string>& others, Random& random) {
  constexpr std::string_view tokens[] = {"-1", "0", "1e999", "nan", "\n", "[", "]",
                                         "{",  "}", "(",     ")",   "\"", ",", "$fn = 9"};
  for (std::uint64_t edits = 1 + random.below(3); edits > 0 && !bytes.empty(); --edits) {
    const std::size_t at = random.below(bytes.size());
    switch (random.below(4)) {
      case 0:
        bytes[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        bytes.erase(at, 1 + random.below(16));
        break;
      case 2:
        bytes.insert(at, tokens[random.below(std::size(tokens))]);
        break;
      default: {
        const std::string& other = others[random.below(others.size())];
        bytes.insert(at, other.substr(random.below(other.size()), random.below(40)));
      }
    }
  }
  return bytes;
}

TEST(SceneCorpus, MutatedFilesGiveAValidShapeOrASentence) {
  const auto files = corpus_files();
  std::vector<std::string> all;
  for (const auto& file : files) all.push_back(read_bytes(file));
  Random random(20240701);
  std::size_t parsed = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(files[i].filename());
    for (int round = 0; round < 150; ++round) {
      const std::string text = mutate(all[i], all, random);
      const std::vector<char> bytes(text.begin(), text.end());  // so that a sanitizer sees a byte read behind it
      try {
        expect_valid(parse_scene({bytes.data(), bytes.size()}, files[i].filename().string(), corpus_folder() / "scene",
                                 ExecutionContext::silent(), {.triangles = 200'000}));
        ++parsed;
      } catch (const UnusableInput& error) {
        ASSERT_GT(std::string(error.what()).size(), 10u);
      } catch (const NotAvailable&) {
      }
    }
  }
  EXPECT_GT(parsed, 0u);
}

}  // namespace
}  // namespace evenmesh::testing_scene
