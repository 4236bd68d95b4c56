/// Every file of the corpus, and thousands of its mutations, either gives a valid mesh or a sentence.

#include <algorithm>

#include "io/bytes.h"
#include "io/zip.h"
#include "io_testing.h"

namespace evenmesh::testing_io {
namespace {

TEST(Corpus, GoodFilesAreReadAndBadOnesAreRefusedByName) {
  const auto files = corpus_files();
  ASSERT_GT(files.size(), 50u);
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename());
    const std::string bytes = read_bytes(file);
    const std::string message = refusal(bytes, file.filename().string());
    const bool bad = file.filename().string().starts_with("bad_");
    EXPECT_EQ(bad, !message.empty()) << message;
    if (bad) {
      EXPECT_TRUE(message.starts_with(file.filename().string() + ": ")) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos);
    } else {
      expect_valid(parse_mesh(bytes, file.filename().string()));
    }
  }
}

TEST(Corpus, ContentWinsOverAWrongExtension) {
  for (const auto& file : corpus_files()) {
    if (file.filename().string().starts_with("bad_")) continue;
    const std::string bytes = read_bytes(file);
    if (!format_of_content(bytes)) continue;  // some forms are known by their extension only
    SCOPED_TRACE(file.filename());
    for (const char* extension : {".ply", ".obj", ".stl", ".off", ".glb", ".3mf", ".txt", ""}) {
      EXPECT_EQ(refusal(bytes, std::string("x") + extension), "");
    }
  }
}

TEST(Corpus, TruncatedFilesNeverHarm) {
  for (const auto& file : corpus_files()) {
    SCOPED_TRACE(file.filename());
    const std::string bytes = read_bytes(file);
    const std::string name = file.filename().string();
    const std::size_t step = std::max<std::size_t>(1, bytes.size() / 150);
    for (std::size_t size = 0; size < bytes.size(); size += step) {
      // A copy of that size, so that a sanitizer sees a byte read behind it.
      const std::vector<char> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      try {
        expect_valid(parse_mesh({cut.data(), cut.size()}, name));
      } catch (const UnusableInput&) {
      }
    }
  }
}

}  // namespace

std::string mutate(std::string bytes, const std::vector<std::string>& others, Random& random) {
  constexpr std::string_view tokens[] = {"-1", "0",  "999999999999", "1e999", "nan", "\n", "/",    "\\\n",
                                         " ",  "\0", "4294967295",   "{}",    "[",   "\"", "-0.5", "#"};
  for (std::uint64_t edits = 1 + random.below(4); edits > 0 && !bytes.empty(); --edits) {
    const std::size_t at = random.below(bytes.size());
    switch (random.below(6)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(random.below(256));
        break;
      case 2:
        bytes.erase(at, 1 + random.below(16));
        break;
      case 3:
        bytes.insert(at, tokens[random.below(std::size(tokens))]);
        break;
      case 4:
        bytes.replace(at, std::min<std::size_t>(4, bytes.size() - at), random.below(2) ? "\xff\xff\xff\xff" : "\x7f");
        break;
      default: {  // splice
        const std::string& other = others[random.below(others.size())];
        bytes.insert(at, other.substr(random.below(other.size()), random.below(40)));
      }
    }
  }
  return bytes;
}

namespace {

TEST(Corpus, MutatedFilesGiveAValidMeshOrASentence) {
  std::vector<std::string> all;
  const auto files = corpus_files();
  for (const auto& file : files) all.push_back(read_bytes(file));
  Random random(20240601);
  std::size_t parsed = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(files[i].filename());
    for (int round = 0; round < 150; ++round) {
      const std::string text = mutate(all[i], all, random);
      const std::vector<char> bytes(text.begin(), text.end());
      try {
        expect_valid(parse_mesh({bytes.data(), bytes.size()}, files[i].filename().string()));
        ++parsed;
      } catch (const UnusableInput& error) {
        ASSERT_GT(std::string(error.what()).size(), 10u);
      }
      ASSERT_FALSE(::testing::Test::HasFatalFailure());
    }
  }
  EXPECT_GT(parsed, 0u);  // otherwise the mutations would be too coarse to get anywhere
}

TEST(Corpus, MutatedModelsInSoundPackagesGiveAValidMeshOrASentence) {
  const std::string model = read_bytes(corpus_folder() / "3mf" / "bad_plain_model.xml");
  const auto wrapped = [](const std::string& text) { return zip_bytes({{"3D/3dmodel.model", text}}); };
  expect_valid(parse_mesh(wrapped(model), "model.3mf"));
  Random random(20240602);
  for (int round = 0; round < 1000; ++round) {
    try {
      expect_valid(parse_mesh(wrapped(mutate(model, {model}, random)), "model.3mf"));
    } catch (const UnusableInput&) {
    }
    ASSERT_FALSE(::testing::Test::HasFatalFailure());
  }
}

}  // namespace
}  // namespace evenmesh::testing_io
