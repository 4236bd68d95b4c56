#include "geometry/union_find.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.h"

namespace evenmesh {
namespace {

/// Labels as they would be written down: all members of a set carry its smallest.
std::vector<std::uint32_t> joined_by_hand(std::size_t size,
                                          const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
  std::vector<std::uint32_t> label(size);
  for (std::uint32_t i = 0; i < size; ++i) label[i] = i;
  for (const auto& [a, b] : pairs) {
    const auto [low, high] = std::minmax({label[a], label[b]});
    std::replace(label.begin(), label.end(), high, low);
  }
  return label;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> random_pairs(std::uint32_t size, std::size_t count) {
  Random random(7);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t i = 0; i < count; ++i)
    pairs.push_back({static_cast<std::uint32_t>(random.below(size)), static_cast<std::uint32_t>(random.below(size))});
  return pairs;
}

TEST(UnionFind, RootsAreTheSmallestMembersWhateverTheOrder) {
  constexpr std::uint32_t size = 500;
  auto pairs = random_pairs(size, 300);
  const std::vector<std::uint32_t> expected = joined_by_hand(size, pairs);
  for (const bool turned : {false, true}) {
    if (turned) std::reverse(pairs.begin(), pairs.end());
    UnionFind sets(size);
    for (const auto& [a, b] : pairs) sets.unite(a, b);
    for (std::uint32_t i = 0; i < size; ++i) {
      EXPECT_EQ(sets.root(i), expected[i]);
      EXPECT_EQ(sets.find(i), expected[i]);
      EXPECT_EQ(sets.is_root(i), expected[i] == i);
    }
  }
}

TEST(UnionFind, FlattenedParentsAreRootsAndMakeTheSameSets) {
  constexpr std::uint32_t size = 200;
  const auto pairs = random_pairs(size, 150);
  UnionFind sets(size);
  for (const auto& [a, b] : pairs) sets.unite(a, b);
  for (std::uint32_t i = 0; i < size; ++i) sets.flatten(i);
  const std::vector<std::uint32_t> parents = sets.take_parents();
  EXPECT_EQ(parents, joined_by_hand(size, pairs));
  UnionFind again(parents);
  again.unite(0, size - 1);
  EXPECT_EQ(again.find(size - 1), 0u);
  EXPECT_EQ(again.size(), size);
}

TEST(UnionFind, JoiningTwiceChangesNothing) {
  UnionFind sets(4);
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(sets.unite(3, 1), round == 0);
    EXPECT_FALSE(sets.unite(1, 3));
    EXPECT_EQ(sets.find(3), 1u);
    EXPECT_TRUE(sets.is_root(0) && sets.is_root(1) && sets.is_root(2) && !sets.is_root(3));
  }
}

}  // namespace
}  // namespace evenmesh
