#include "core/grouping.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace evenmesh {
namespace {

TEST(Grouping, ListsTheItemsOfEveryKeyInOrder) {
  for (const std::size_t keys : {1u, 5u, 255u, 256u, 257u, 1000u, 70'000u})
    for (const std::size_t count : {0u, 1u, 100u, 20'000u, 100'001u}) {
      std::vector<std::uint32_t> key(count);
      Random random(keys + count);
      for (std::uint32_t& k : key)
        k = random.below(10) == 0 ? no_group : static_cast<std::uint32_t>(random.below(keys));
      std::vector<std::vector<std::uint32_t>> expected(keys);
      for (std::uint32_t i = 0; i < count; ++i)
        if (key[i] != no_group) expected[key[i]].push_back(i);
      for (const unsigned threads : {1u, 2u, 7u}) {
        ExecutionContext context(threads);
        const Groups groups = with_threads(
            context, [&] { return group_by_key(context, count, keys, [&](std::size_t i) { return key[i]; }); });
        ASSERT_EQ(groups.start.size(), keys + 1);
        for (std::size_t k = 0; k < keys; ++k) {
          const auto items = groups.of(k);
          ASSERT_TRUE(std::equal(items.begin(), items.end(), expected[k].begin(), expected[k].end()))
              << keys << " keys, " << count << " items, key " << k;
        }
      }
    }
}

TEST(Grouping, OfNothingIsEmpty) {
  ExecutionContext context(1);
  const Groups groups = group_by_key(context, 0, 0, [](std::size_t) { return no_group; });
  EXPECT_EQ(groups.start, std::vector<std::uint32_t>{0});
  EXPECT_TRUE(groups.items.empty());
}

}  // namespace
}  // namespace evenmesh
