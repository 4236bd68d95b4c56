#include "grid/coarsen.h"

#include <algorithm>

#include "grid/blocks.h"

namespace evenmesh {
namespace {

// Whether a sample of the axis lies on a ray that the coarser grid has too: its two coordinates across the ray are
// even.
bool is_kept(EdgeCode code, int axis) {
  constexpr unsigned odd_across[3] = {1u << 4 | 1u << 1, 1u << 7 | 1u << 1, 1u << 7 | 1u << 4};
  return (code.bits & odd_across[axis]) == 0;
}

struct CoarseBlock {
  std::uint32_t first_child, children;
};

// Fine blocks that share a coarse one follow each other in Morton order.
std::vector<CoarseBlock> group_blocks(const SampleSet& fine) {
  std::vector<CoarseBlock> groups;
  const auto parent = [&](std::size_t b, std::size_t a) { return fine.blocks[b].brick[a] / 2; };
  for (std::uint32_t b = 0; b < fine.blocks.size(); ++b) {
    const bool same = b > 0 && parent(b, 0) == parent(b - 1, 0) && parent(b, 1) == parent(b - 1, 1) &&
                      parent(b, 2) == parent(b - 1, 2);
    if (same)
      ++groups.back().children;
    else
      groups.push_back({b, 1});
  }
  return groups;
}

void copy_block(const SampleSet& fine, const SampleBlock& from, int axis, SampleSet& coarse, std::uint32_t& out) {
  const float h = static_cast<float>(fine.grid.spacing);
  float shift[3];
  unsigned first_cell[3];
  for (std::size_t a = 0; a < 3; ++a) {
    const bool upper = from.brick[a] % 2 != 0;
    shift[a] = (upper ? 0.5f : -0.5f) * brick_size * h;
    first_cell[a] = upper ? brick_size / 2 : 0;
  }
  for (std::uint32_t i = from.begin_of_axis(axis); i < from.end_of_axis(axis); ++i) {
    const EdgeCode code = fine.edge[i];
    if (!is_kept(code, axis)) continue;
    copy_sample(fine, i, coarse, out);
    coarse.x[out] += shift[0];
    coarse.y[out] += shift[1];
    coarse.z[out] += shift[2];
    coarse.area[out] *= 4.0f;
    if (!coarse.even()) coarse.weight[out] *= 4.0f;
    coarse.edge[out] = EdgeCode(code.axis(), first_cell[0] + code.i() / 2, first_cell[1] + code.j() / 2,
                                first_cell[2] + code.k() / 2, code.lower_end_inside());
    ++out;
  }
}

}  // namespace

SampleSet coarsen(const SampleSet& fine, ExecutionContext& context) {
  return with_threads(context, [&] {
    SampleSet coarse;
    coarse.grid = {fine.grid.origin, 2 * fine.grid.spacing, fine.grid.size};
    for (std::uint32_t& n : coarse.grid.size) n = n / 2 + 1;
    coarse.disagreements = fine.disagreements;
    coarse.unresolved = fine.unresolved;
    coarse.cut_by_bounds = fine.cut_by_bounds;
    const std::vector<CoarseBlock> groups = group_blocks(fine);
    std::vector<std::uint32_t> kept(groups.size());
    parallel_for(context, groups.size(), 32, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g) {
        for (std::uint32_t c = 0; c < groups[g].children; ++c) {
          const SampleBlock& block = fine.blocks[groups[g].first_child + c];
          for (int axis = 0; axis < 3; ++axis)
            for (std::uint32_t i = block.begin_of_axis(axis); i < block.end_of_axis(axis); ++i)
              kept[g] += is_kept(fine.edge[i], axis) ? 1 : 0;
        }
      }
    });
    std::vector<std::uint32_t> child;
    std::uint32_t sum = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (kept[g] == 0) continue;
      const SampleBlock& first = fine.blocks[groups[g].first_child];
      SampleBlock block{sum, sum + kept[g], first.brick, {}};
      for (std::uint16_t& b : block.brick) b = static_cast<std::uint16_t>(b / 2);
      coarse.blocks.push_back(block);
      child.push_back(static_cast<std::uint32_t>(g));
      sum += kept[g];
    }
    resize_like(coarse, fine, sum, context);
    parallel_for(context, coarse.blocks.size(), 32, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        const CoarseBlock& group = groups[child[b]];
        std::uint32_t out = coarse.blocks[b].begin;
        for (int axis = 0; axis < 3; ++axis) {
          if (axis > 0) coarse.blocks[b].axis_begin[static_cast<std::size_t>(axis) - 1] = out;
          for (std::uint32_t c = 0; c < group.children; ++c)
            copy_block(fine, fine.blocks[group.first_child + c], axis, coarse, out);
        }
      }
    });
    sum_area(coarse, context);
    return coarse;
  });
}

SampleSet one_sample_per_edge(const SampleSet& set, const ExecutionContext& context) {
  std::vector<std::vector<std::uint32_t>> kept(set.blocks.size());
  parallel_for(context, set.blocks.size(), 32, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> order;
    for (std::size_t b = begin; b < end; ++b) {
      order.resize(set.blocks[b].end - set.blocks[b].begin);
      for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = set.blocks[b].begin + i;
      std::stable_sort(order.begin(), order.end(),
                       [&](auto i, auto j) { return set.edge[i].bits >> 1 < set.edge[j].bits >> 1; });
      for (std::size_t i = 0; i < order.size();) {
        std::size_t next = i + 1;
        while (next < order.size() && set.edge[order[next]].bits >> 1 == set.edge[order[i]].bits >> 1) ++next;
        if ((next - i) % 2 != 0) kept[b].push_back(order[i]);
        i = next;
      }
    }
  });
  SampleSet result;
  result.grid = set.grid;
  result.cut_by_bounds = set.cut_by_bounds;
  std::uint32_t sum = 0;
  for (std::size_t b = 0; b < kept.size(); ++b) {
    if (kept[b].empty()) continue;
    const auto count = static_cast<std::uint32_t>(kept[b].size());
    result.blocks.push_back({sum, sum + count, set.blocks[b].brick, {}});
    sum += count;
  }
  std::erase_if(kept, [](const auto& list) { return list.empty(); });
  resize_like(result, set, sum, context);
  parallel_for(context, kept.size(), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t i = 0; i < kept[b].size(); ++i) copy_sample(set, kept[b][i], result, result.blocks[b].begin + i);
  });
  mark_axes(result, context);
  sum_area(result, context);
  return result;
}

}  // namespace evenmesh
