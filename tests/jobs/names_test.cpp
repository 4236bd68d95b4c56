#include "evenmesh/names.h"

#include <gtest/gtest.h>

#include <set>

#include "evenmesh/error.h"
#include "evenmesh/solid.h"

namespace evenmesh {
namespace {

template <typename Enum>
class Names : public testing::Test {};
using Enums =
    testing::Types<Method, Quality, Optimizer, Start, Connect, TopologyRule, Placement, Hull, SetOperation, MeshFormat>;
TYPED_TEST_SUITE(Names, Enums);

TYPED_TEST(Names, GoThereAndBackWithoutGapsOrTwins) {
  std::set<std::string_view> seen;
  int next = 0;
  for (const Named<TypeParam>& entry : names<TypeParam>()) {
    EXPECT_EQ(static_cast<int>(entry.value), next++) << entry.name << ": tables list enumerators in their order";
    EXPECT_TRUE(seen.insert(entry.name).second) << entry.name;
    EXPECT_EQ(name_of(entry.value), entry.name);
    EXPECT_EQ(value_of<TypeParam>(entry.name), entry.value);
    EXPECT_EQ(entry.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string_view::npos);
  }
  EXPECT_EQ(name_of(static_cast<TypeParam>(next)), "") << "the table ends with the last enumerator";
  EXPECT_EQ(value_of<TypeParam>(""), std::nullopt);
  EXPECT_EQ(value_of<TypeParam>("AUTO"), std::nullopt);
}

TEST(NamesOf, FormatsAreTheirExtensions) {
  for (const Named<MeshFormat>& entry : names<MeshFormat>())
    EXPECT_EQ(format_of_name("mesh." + std::string(entry.name)), entry.value) << entry.name;
}

TEST(NamesOf, AreJoined) {
  EXPECT_EQ(joined_names<Method>(), "auto, raster, shell");
  EXPECT_EQ(joined_names<Quality>("|"), "fast|normal|high");
}

TEST(SetOperations, MakeCompounds) {
  const auto balls = [] { return std::vector{gallery_shape("sphere"), gallery_shape("torus"), gallery_shape("cube")}; };
  const auto kind = [&](SetOperation operation) { return combined(operation, balls()).compound()->kind; };
  EXPECT_EQ(kind(SetOperation::unite), Compound::Kind::unite);
  EXPECT_EQ(kind(SetOperation::intersect), Compound::Kind::intersect);
  EXPECT_EQ(kind(SetOperation::subtract), Compound::Kind::subtract);
  EXPECT_EQ(combined(SetOperation::subtract, balls()).compound()->operands.size(), 3u);
  for (const Named<SetOperation>& entry : names<SetOperation>())
    EXPECT_THROW(combined(entry.value, {}), InvalidInput) << entry.name;
}

}  // namespace
}  // namespace evenmesh
