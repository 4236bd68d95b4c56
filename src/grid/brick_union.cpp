#include "grid/brick_union.h"

#include <algorithm>

namespace evenmesh {
namespace {

std::vector<std::uint32_t> own_parents(std::size_t size, const ExecutionContext& context) {
  std::vector<std::uint32_t> parents(size);
  parallel_for(context, size, 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) parents[i] = static_cast<std::uint32_t>(i);
  });
  return parents;
}

}  // namespace

BrickUnion::BrickUnion(const SampleSet& samples, const std::vector<CubeBrick>& bricks, const ExecutionContext& context)
    : own_(bricks.size()), sets_(own_parents(samples.size(), context)), across_(bricks.size()) {
  for (std::size_t b = 0; b < bricks.size(); ++b)
    if (const std::int64_t block = bricks[b].block[0]; block >= 0)
      own_[b] = {samples.blocks[block].begin, samples.blocks[block].end - samples.blocks[block].begin};
}

void BrickUnion::flatten(const ExecutionContext& context) {
  // Roots stay roots: no other thread's walk is misled.
  parallel_for(context, sets_.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sets_.flatten(static_cast<std::uint32_t>(i));
  });
}

void BrickUnion::settle(const ExecutionContext& context) {
  flatten(context);
  parallel_for(context, across_.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      // Few roots meet in one brick: looking through the pairs found so far, the latest first, is fast.
      auto& pairs = across_[b];
      auto last = pairs.begin();
      for (const auto& [s, t] : pairs) {
        const std::pair<std::uint32_t, std::uint32_t> pair = std::minmax({sets_.root(s), sets_.root(t)});
        if (pair.first == pair.second) continue;
        if (std::find(std::make_reverse_iterator(last), pairs.rend(), pair) == pairs.rend()) *last++ = pair;
      }
      pairs.erase(last, pairs.end());
    }
  });
  for (const auto& pairs : across_)
    for (const auto& [s, t] : pairs) sets_.unite(s, t);
  across_.clear();
}

}  // namespace evenmesh
