/// The cubes that a surface passes through, and which of its samples are neighbours.
#include "grid/brick_cubes.h"

#include <bit>
#include <map>

#include "evenmesh/error.h"
#include "geometry/primitives.h"
#include "grid/blocks.h"
#include "grid/sample_checks.h"

namespace evenmesh {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;
using Counts = std::map<Pair, int>;

SampleSet half_of(const SampleSet& whole) {
  std::vector<std::uint32_t> blocks;
  for (std::uint32_t b = 0; b < whole.blocks.size(); ++b)
    if (whole.block_center(whole.blocks[b]).x > 0.2) blocks.push_back(b);
  return part_of(whole, blocks);
}

/// Neighbours on all loops, the lower first, and how often they come.
Counts neighbours(const SampleSet& set) {
  Counts counts;
  CubeWalker walker(set);
  for (const CubeBrick& brick : cube_bricks(set, ExecutionContext::silent()))
    walker.walk(brick, [&](const std::uint32_t* loop, int n) {
      for (int i = 0; i < n; ++i) ++counts[std::minmax(loop[i], loop[(i + 1) % n])];
    });
  return counts;
}

Counts links(const SampleSet& set) {
  Counts counts;
  CubeWalker walker(set);
  for (const CubeBrick& brick : cube_bricks(set, ExecutionContext::silent()))
    walker.walk_links(brick, [&](const std::uint32_t* loop, int n, unsigned bits) {
      for (; bits != 0; bits &= bits - 1) {
        const int i = std::countr_zero(bits);
        ASSERT_LT(i, n);
        ++counts[std::minmax(loop[i], loop[(i + 1) % n])];
      }
    });
  return counts;
}

TEST(CubeBricks, KnowTheBlocksAroundThem) {
  const SampleSet set = sampled(make_torus(), 60);
  std::map<std::array<int, 3>, int> block_at;
  for (std::size_t b = 0; b < set.blocks.size(); ++b) {
    const auto& at = set.blocks[b].brick;
    block_at[{at[0], at[1], at[2]}] = static_cast<int>(b);
  }
  std::size_t own = 0;
  for (const CubeBrick& brick : cube_bricks(set, ExecutionContext::silent()))
    for (int d = 0; d < 8; ++d) {
      const auto found = block_at.find({brick.at[0] + (d & 1), brick.at[1] + (d >> 1 & 1), brick.at[2] + (d >> 2)});
      EXPECT_EQ(brick.block[static_cast<std::size_t>(d)], found == block_at.end() ? -1 : found->second);
      own += d == 0 && found != block_at.end();
    }
  EXPECT_EQ(own, set.blocks.size());
}

TEST(CubeWalker, MeetsEveryPairFromTwoCubesAndLinksItOnce) {
  const SampleSet set = sampled(make_torus(), 60);
  Counts twice = neighbours(set);
  EXPECT_EQ(twice.size(), 2 * set.size()) << "four neighbours each";
  for (const auto& [pair, count] : twice) EXPECT_EQ(count, 2);
  for (auto& [pair, count] : twice) count = 1;
  EXPECT_EQ(links(set), twice);
}

TEST(CubeWalker, LinksAllOfAPart) {
  const SampleSet part = half_of(sampled(make_torus(), 60));
  EXPECT_EQ(links(part), neighbours(part));
}

TEST(CubeWalker, RefusesWhatBoundsNoSolid) {
  const SampleSet set = sampled(make_torus(), 40);
  const auto gap = static_cast<std::uint32_t>(set.size() / 2);
  EXPECT_THROW(neighbours(keep_samples(set, [&](std::uint32_t s) { return s != gap; })), Error);
}

}  // namespace
}  // namespace evenmesh
