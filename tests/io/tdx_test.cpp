#include <gtest/gtest.h>

#include "evenmesh/error.h"
#include "evenmesh/io.h"

namespace evenmesh {
namespace {

TEST(DexelFile, ComesBackAsItWas) {
  const Dexels dexels{
      {1, -2, 3}, 0.25, {10, 20, 30}, {{{1, 2, 3}, 0, true, 0.5f, 77}, {{4, 5, 6}, 2, false, 1, 0xffffffffu}}};
  const std::string bytes = serialize_dexels(dexels);
  EXPECT_EQ(bytes.size(), 96u + 32u);
  EXPECT_TRUE(is_dexel_file(bytes));
  const Dexels again = parse_dexels(bytes, "a.tdx");
  EXPECT_EQ(again.origin, dexels.origin);
  EXPECT_EQ(again.spacing, dexels.spacing);
  EXPECT_EQ(again.size, dexels.size);
  EXPECT_EQ(again.crossings, dexels.crossings);
  for (const std::size_t cut : {0u, 5u, 40u, 95u, 97u, 127u})
    EXPECT_THROW(parse_dexels(bytes.substr(0, cut), "a.tdx"), UnusableInput) << cut;
  EXPECT_THROW(parse_dexels(bytes + "x", "a.tdx"), UnusableInput);
}

TEST(DexelFile, OtherReadersSayWhatItIs) {
  const std::string bytes = serialize_dexels({{0, 0, 0}, 1, {1, 1, 1}, {}});
  EXPECT_TRUE(is_dexel_file("evenmesh dexels 2\n"));
  EXPECT_FALSE(is_dexel_file("evenmesh"));
  try {
    parse_mesh(bytes, "a.ply");
    FAIL();
  } catch (const UnusableInput& error) {
    EXPECT_NE(std::string(error.what()).find("a.ply: holds dexels, not a mesh"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace evenmesh
