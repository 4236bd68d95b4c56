#include "grid/solid_editor.h"

#include <algorithm>
#include <cmath>

#include "grid/blocks.h"
#include "grid/morton.h"

namespace evenmesh {
namespace {

std::uint64_t key_of(const std::array<std::uint16_t, 3>& brick) {
  return morton_code(brick[0], brick[1], brick[2]);
}

/// Samples [begin, end) of a brick, before or after the change.
struct Source {
  const SampleColumns* samples;
  std::size_t begin, end;
  std::array<std::uint16_t, 3> brick;
};

}  // namespace

void BrickSigns::load(const SampleSet& samples, const SampleBlock& block) {
  crossing_.fill(none);
  for (std::uint32_t s = block.begin; s < block.end; ++s) {
    const EdgeCode e = samples.edge[s];
    const auto at = index(static_cast<int>(e.i()), static_cast<int>(e.j()), static_cast<int>(e.k()));
    crossing_[e.axis() * volume + at] = s;
  }
  inside_.fill(false);
  for (int k = 0; k < points; ++k) {
    if (k > 0) inside(0, 0, k) = inside(0, 0, k - 1) != (crossing(2, 0, 0, k - 1) != none);
    for (int j = 0; j < points; ++j) {
      if (j > 0) inside(0, j, k) = inside(0, j - 1, k) != (crossing(1, 0, j - 1, k) != none);
      for (int i = 1; i < side; ++i) inside(i, j, k) = inside(i - 1, j, k) != (crossing(0, i - 1, j, k) != none);
    }
    for (int i = 0; i < points; ++i)
      inside(i, points, k) = inside(i, points - 1, k) != (crossing(1, i, points - 1, k) != none);
  }
  for (int j = 0; j < points; ++j)
    for (int i = 0; i < points; ++i)
      inside(i, j, points) = inside(i, j, points - 1) != (crossing(2, i, j, points - 1) != none);
  const EdgeCode first = samples.edge[block.begin];
  const bool lower = inside(static_cast<int>(first.i()), static_cast<int>(first.j()), static_cast<int>(first.k()));
  if (lower != first.lower_end_inside())
    for (bool& b : inside_) b = !b;
}

void BrickSigns::fill(bool value) {
  crossing_.fill(none);
  inside_.fill(value);
}

SolidEditor::SolidEditor(const SampleSet& samples) : samples_(samples) {
  for (const SampleBlock& b : samples.blocks) keys_.push_back(key_of(b.brick));
}

std::int64_t SolidEditor::block_at(Brick brick) const {
  const std::uint64_t key = key_of(brick);
  const auto it = std::lower_bound(keys_.begin(), keys_.end(), key);
  return it != keys_.end() && *it == key ? it - keys_.begin() : -1;
}

SolidEditor::Sums SolidEditor::sums_of(Brick brick) const {
  const std::int64_t at = block_at(brick);
  if (at < 0) return {};
  Sums sums;
  const SampleBlock& block = samples_.blocks[static_cast<std::size_t>(at)];
  const std::span<const float> weights = samples_.weights();
  for (std::uint32_t i = block.begin; i < block.end; ++i) {
    sums.area += samples_.area[i];
    sums.weight += weights[i];
  }
  return sums;
}

BrickSigns SolidEditor::signs(Brick brick) const {
  BrickSigns signs;
  if (const std::int64_t own = block_at(brick); own >= 0) {
    signs.load(samples_, samples_.blocks[static_cast<std::size_t>(own)]);
    return signs;
  }
  while (brick[0] > 0) {
    --brick[0];
    const std::int64_t b = block_at(brick);
    if (b < 0) continue;
    signs.load(samples_, samples_.blocks[static_cast<std::size_t>(b)]);
    signs.fill(signs.inside(BrickSigns::points, 0, 0));
    return signs;
  }
  signs.fill(false);
  return signs;
}

bool SolidEditor::on_border(Brick brick, int i, int j, int k) const {
  const std::array<int, 3> at{8 * brick[0] + i, 8 * brick[1] + j, 8 * brick[2] + k};
  for (std::size_t a = 0; a < 3; ++a)
    if (at[a] <= 0 || at[a] + 1 >= static_cast<int>(samples_.grid.size[a])) return true;
  return false;
}

std::vector<std::pair<std::uint64_t, std::vector<std::uint32_t>>> SolidEditor::bricks_near(
    std::span<const Vec3> centers, std::span<const double> reach) const {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> pairs;
  const Grid& g = samples_.grid;
  for (std::uint32_t c = 0; c < centers.size(); ++c) {
    std::array<std::int64_t, 3> lo{}, hi{};
    for (int a = 0; a < 3; ++a) {
      const auto at = static_cast<std::size_t>(a);
      const auto count = static_cast<std::int64_t>(g.size[at]);
      const double center = (centers[c][a] - g.origin[a]) / g.spacing, cells = reach[c] / g.spacing + 1.5;
      lo[at] = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(center - cells))) / 8;
      hi[at] = std::min(count - 1, static_cast<std::int64_t>(std::ceil(center + cells))) / 8;
    }
    for (std::int64_t k = lo[2]; k <= hi[2]; ++k)
      for (std::int64_t j = lo[1]; j <= hi[1]; ++j)
        for (std::int64_t i = lo[0]; i <= hi[0]; ++i)
          pairs.push_back(
              {morton_code(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j), static_cast<std::uint64_t>(k)),
               c});
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::pair<std::uint64_t, std::vector<std::uint32_t>>> bricks;
  for (const auto& [key, c] : pairs) {
    if (bricks.empty() || bricks.back().first != key) bricks.push_back({key, {}});
    bricks.back().second.push_back(c);
  }
  return bricks;
}

void SolidEditor::add_old(const CrossedEdge& edge, NewBlock& out) const {
  for_each_column(
      [&](const auto& from_old, auto& column) {
        if (from_old.empty()) return;
        column.emplace_back();
        if (edge.old != BrickSigns::none) column.back() = from_old[edge.old];
      },
      samples_, out);
  out.edge.back() = EdgeCode(static_cast<unsigned>(edge.axis), static_cast<unsigned>(edge.at[0]),
                             static_cast<unsigned>(edge.at[1]), static_cast<unsigned>(edge.at[2]), edge.lower_inside);
}

void SolidEditor::set_last(const CrossedEdge& edge, const NewCrossing& made, NewBlock& out) const {
  const double h = samples_.grid.spacing;
  Vec3 p = h * Vec3{edge.at[0] - 4.0, edge.at[1] - 4.0, edge.at[2] - 4.0};
  p[edge.axis] += h * (edge.lower_inside ? made.t : 1 - made.t);
  out.x.back() = static_cast<float>(p.x);
  out.y.back() = static_cast<float>(p.y);
  out.z.back() = static_cast<float>(p.z);
  const double area = sample_area(made.normal, edge.axis, h);
  out.area.back() = static_cast<float>(area);
  if (!out.even()) out.weight.back() = static_cast<float>(area * made.relative_weight);
  out.normal.back() = pack_normal(made.normal);
}

SampleSet SolidEditor::replace(std::span<const NewBlock> made, ExecutionContext& context) const {
  std::vector<Source> list;
  std::size_t next = 0;
  for (std::size_t b = 0; b <= keys_.size(); ++b) {
    const std::uint64_t key = b < keys_.size() ? keys_[b] : ~std::uint64_t{0};
    bool replaced = false;
    for (; next < made.size() && key_of(made[next].brick) <= key; ++next) {
      if (made[next].size() > 0) list.push_back({&made[next], 0, made[next].size(), made[next].brick});
      replaced |= key_of(made[next].brick) == key;
    }
    if (b == keys_.size() || replaced) continue;
    const SampleBlock& block = samples_.blocks[b];
    list.push_back({&samples_, block.begin, block.end, block.brick});
  }
  SampleSet out;
  out.grid = samples_.grid;
  out.disagreements = samples_.disagreements;
  out.unresolved = samples_.unresolved;
  out.cut_by_bounds = samples_.cut_by_bounds;
  std::size_t count = 0;
  for (const Source& from : list) {
    const auto begin = static_cast<std::uint32_t>(count);
    count += from.end - from.begin;
    out.blocks.push_back({begin, static_cast<std::uint32_t>(count), from.brick, {}});
  }
  resize_like(out, samples_, count, context);
  parallel_for(context, list.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      copy_samples(*list[b].samples, list[b].begin, list[b].end, out, out.blocks[b].begin);
  });
  mark_axes(out, context);
  for (const float area : out.area) out.total_area += area;
  for (const float weight : out.weights()) out.total_weight += weight;
  return out;
}

}  // namespace evenmesh
