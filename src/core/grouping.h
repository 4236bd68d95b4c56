#pragma once
/// Items sorted by small whole numbers, in parallel.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.h"

namespace evenmesh {

/// Items 0, 1, 2, … by their keys.
struct Groups {
  std::vector<std::uint32_t> start;  ///< by key, and one more: where its items begin
  std::vector<std::uint32_t> items;  ///< ascending within a key

  std::span<const std::uint32_t> of(std::size_t key) const {
    return {items.data() + start[key], start[key + 1] - start[key]};
  }
};

/// Key of items that belong to no group.
inline constexpr std::uint32_t no_group = 0xffffffffu;

/// Groups `count` items by key(item) < keys, or no_group. A stable counting sort: first into at most 256 ranges of
/// keys, piece by piece of the items, then every range on its own. Calls key twice for every item. Same result for any
/// number of threads. Cost: some 5 ns per item, 8 bytes of memory for each on the way.
/// @pre  count < 2³²
template <typename Key>
Groups group_by_key(const ExecutionContext& context, std::size_t count, std::size_t keys, const Key& key) {
  constexpr std::size_t max_ranges = 256, max_pieces = 64, least_piece = 8192;
  struct Entry {
    std::uint32_t key, item;
  };
  unsigned shift = 0;
  while ((keys >> shift) >= max_ranges) ++shift;
  const std::size_t ranges = (keys >> shift) + 1;
  const std::size_t pieces = std::clamp<std::size_t>(count / least_piece, 1, max_pieces);
  const auto for_entries = [&](std::size_t piece, const auto& visit) {
    for (std::size_t i = count * piece / pieces; i < count * (piece + 1) / pieces; ++i)
      if (const std::uint32_t k = key(i); k != no_group) visit(k, static_cast<std::uint32_t>(i));
  };

  // Where each piece puts the items of each range: range by range, pieces in order.
  std::vector<std::uint32_t> place(ranges * pieces + 1, 0);
  parallel_tasks(context, pieces, [&](std::size_t piece) {
    std::vector<std::uint32_t> tally(ranges, 0);
    for_entries(piece, [&](std::uint32_t k, std::uint32_t) { ++tally[k >> shift]; });
    for (std::size_t r = 0; r < ranges; ++r) place[r * pieces + piece + 1] = tally[r];
  });
  for (std::size_t i = 0; i + 1 < place.size(); ++i) place[i + 1] += place[i];
  std::vector<Entry> entries(place.back());
  parallel_tasks(context, pieces, [&](std::size_t piece) {
    std::vector<std::uint32_t> at(ranges);
    for (std::size_t r = 0; r < ranges; ++r) at[r] = place[r * pieces + piece];
    for_entries(piece, [&](std::uint32_t k, std::uint32_t item) { entries[at[k >> shift]++] = {k, item}; });
  });

  Groups groups{std::vector<std::uint32_t>(keys + 1), std::vector<std::uint32_t>(entries.size())};
  parallel_tasks(context, ranges, [&](std::size_t range) {
    const std::size_t first = range << shift, last = std::min(keys, (range + 1) << shift);
    const std::span<const Entry> mine(entries.data() + place[range * pieces],
                                      entries.data() + place[(range + 1) * pieces]);
    std::vector<std::uint32_t> at(last - first + 1, 0);
    for (const Entry& e : mine) ++at[e.key - first + 1];
    at[0] = place[range * pieces];
    for (std::size_t k = first; k < last; ++k) {
      at[k - first + 1] += at[k - first];
      groups.start[k] = at[k - first];
    }
    for (const Entry& e : mine) groups.items[at[e.key - first]++] = e.item;
  });
  groups.start[keys] = static_cast<std::uint32_t>(entries.size());
  return groups;
}

}  // namespace evenmesh
