#include "measure/box_pairs.h"

#include <algorithm>
#include <numeric>

namespace evenmesh {
namespace {

constexpr unsigned bits_per_axis = 11;

/// Bits 0, 1, 2, … of x to bits 0, 3, 6, …
std::uint64_t spread(std::uint64_t x) {
  std::uint64_t result = 0;
  for (unsigned i = 0; i < bits_per_axis; ++i) result |= (x >> i & 1) << (3 * i);
  return result;
}

/// One pass of a stable radix sort by the 11 bits of the keys from `shift` on.
void radix_pass(const std::vector<std::uint64_t>& keys, const std::vector<std::uint32_t>& from,
                std::vector<std::uint32_t>& to, unsigned shift) {
  std::array<std::uint32_t, 1 << 11> start{};
  const auto digit = [&](std::uint32_t i) { return keys[i] >> shift & (start.size() - 1); };
  for (const std::uint32_t i : from) ++start[digit(i)];
  std::exclusive_scan(start.begin(), start.end(), start.begin(), 0u);
  for (const std::uint32_t i : from) to[start[digit(i)]++] = i;
}

}  // namespace

BoxPairs::BoxPairs(const std::vector<Box>& boxes, const ExecutionContext& context) {
  Box all;
  for (const Box& box : boxes)
    if (!box.empty()) {
      all.add(box.lo);
      all.add(box.hi);
    }
  sort_along_curve(boxes, all);
  context.throw_if_cancelled();

  order_.resize((order_.size() + width - 1) / width * width, 0);
  std::vector<Eight> lowest(order_.size() / width);
  const Vec3 center = all.center();
  const double diagonal = all.diagonal(), scale = diagonal > 0 ? 1 / diagonal : 1;  // keeps tiny models off underflow
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box& box = boxes[order_[i]];
    if (box.empty()) continue;
    for (int k = 0; k < 3; ++k) {
      lowest[i / width].side[k][i % width] = static_cast<float>((box.lo[k] - center[k]) * scale);
      lowest[i / width].side[k + 3][i % width] = static_cast<float>((box.hi[k] - center[k]) * scale);
    }
  }
  levels_.push_back(std::move(lowest));
  build_levels();
}

void BoxPairs::sort_along_curve(const std::vector<Box>& boxes, const Box& all) {
  static const std::vector<std::uint64_t> spreads = [] {
    std::vector<std::uint64_t> table(1u << bits_per_axis);
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = spread(i);
    return table;
  }();
  const Vec3 size = all.empty() ? Vec3{} : all.size();
  const double longest = std::max({size.x, size.y, size.z}), cells = (1u << bits_per_axis) - 1;
  const double scale = longest > 0 ? cells / longest : 0;
  std::vector<std::uint64_t> keys(boxes.size(), 0);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].empty()) continue;
    const Vec3 at = (boxes[i].center() - all.lo) * scale;
    for (int k = 0; k < 3; ++k) keys[i] |= spreads[static_cast<std::size_t>(std::clamp(at[k], 0.0, cells))] << k;
  }
  order_.resize(boxes.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<std::uint32_t> other(order_.size());
  for (unsigned shift = 0; shift < 3 * bits_per_axis; shift += 11) {
    radix_pass(keys, order_, other, shift);
    order_.swap(other);
  }
}

void BoxPairs::build_levels() {
  while (levels_.back().size() > 1) {
    const std::vector<Eight>& below = levels_.back();
    std::vector<Eight> level((below.size() + width - 1) / width);
    for (std::size_t i = 0; i < below.size(); ++i)
      for (int k = 0; k < 6; ++k) {
        const auto [lo, hi] = std::minmax_element(below[i].side[k].begin(), below[i].side[k].end());
        level[i / width].side[k][i % width] = k < 3 ? *lo : *hi;
      }
    levels_.push_back(std::move(level));
  }
}

}  // namespace evenmesh
