#include "core/platform.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace evenmesh {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("evenmesh-files-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string content(const fs::path& path) const {
    FileBytes bytes;
    EXPECT_FALSE(read_to_end(path, bytes)) << path;
    return std::string(bytes.view());
  }
  std::ptrdiff_t count() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }

  fs::path folder_;
};

TEST_F(Files, AreReadAsTheyWereWritten) {
  for (const std::string& bytes : {std::string(), std::string("a\0b\n", 4), std::string(1'000'000, 'x')}) {
    ASSERT_FALSE(replace_file(folder_ / "a", bytes));
    EXPECT_EQ(content(folder_ / "a"), bytes);
  }
  EXPECT_EQ(count(), 1) << "no temporary file is left";
  EXPECT_FALSE(content("/proc/self/status").empty()) << "its size is not known in advance";
}

TEST_F(Files, KeepTheirPermissions) {
  ASSERT_FALSE(replace_file(folder_ / "a", "old"));
  fs::permissions(folder_ / "a", fs::perms::owner_all);
  ASSERT_FALSE(replace_file(folder_ / "a", "new"));
  EXPECT_EQ(fs::status(folder_ / "a").permissions(), fs::perms::owner_all);
}

TEST_F(Files, ErrorsSayWhatAndLeaveNothing) {
  FileBytes bytes;
  EXPECT_EQ(read_to_end(folder_ / "none", bytes), std::errc::no_such_file_or_directory);
  EXPECT_EQ(read_to_end(folder_, bytes), std::errc::is_a_directory);
  EXPECT_EQ(replace_file(folder_ / "none" / "a", "x"), std::errc::no_such_file_or_directory);
  EXPECT_TRUE(replace_file(folder_, "x")) << "a folder is no file";
  EXPECT_EQ(write_into(folder_ / "none", "x"), std::errc::no_such_file_or_directory) << "makes no file";
  EXPECT_EQ(write_into("/dev/full", "x"), std::errc::no_space_on_device);
  EXPECT_EQ(count(), 0);
}

TEST_F(Files, MayBeWrittenOrNot) {
  EXPECT_TRUE(may_write(folder_));
  EXPECT_FALSE(may_write(folder_ / "none"));
}

TEST(Platform, TellsMemory) {
  const std::size_t before = peak_memory_bytes();
  EXPECT_GT(before, 100'000u);
  constexpr std::size_t much = 200'000'000;
  const std::vector<char> block(much, 'x');
  EXPECT_GE(peak_memory_bytes(), before);
  EXPECT_GT(peak_memory_bytes(), much) << "bytes, not kilobytes: " << block[1];
}

TEST(Platform, KnowsItsFolder) {
  EXPECT_TRUE(fs::is_directory(program_folder()));
}

TEST(Platform, LoadsLibraries) {
  std::string reason;
  EXPECT_EQ(load_library("/none/library.so", reason), nullptr);
  EXPECT_NE(reason.find("library.so"), std::string::npos) << reason;
  void* math = load_library("libm.so.6", reason);
  ASSERT_NE(math, nullptr) << reason;
  EXPECT_NE(find_symbol(math, "cos"), nullptr);
  EXPECT_EQ(find_symbol(math, "evenmesh_none"), nullptr);
}

}  // namespace
}  // namespace evenmesh
