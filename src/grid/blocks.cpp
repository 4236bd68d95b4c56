#include "grid/blocks.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <stdexcept>

#include "evenmesh/error.h"
#include "grid/morton.h"

namespace evenmesh {

namespace {

using ColumnSizes = std::vector<std::function<void()>>;

void run(const ColumnSizes& tasks, const ExecutionContext& context) {
  parallel_tasks(context, tasks.size(), [&](std::size_t i) { tasks[i](); });
}

void check_count(std::size_t count) {
  if (count > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput("more than 4 billion samples: lower the resolution");
}

}  // namespace

void resize_samples(SampleSet& set, std::size_t count, bool with_sources, const ExecutionContext& context) {
  check_count(count);
  ColumnSizes tasks;
  for_each_column(
      [&](auto& column) {
        const void* which = &column;
        const bool unused = which == &set.weight || (which == &set.source && !with_sources);
        tasks.emplace_back([&column, size = unused ? 0 : count] { column.resize(size); });
      },
      set);
  run(tasks, context);
}

void resize_like(SampleColumns& to, const SampleColumns& like, std::size_t count, const ExecutionContext& context) {
  check_count(count);
  ColumnSizes tasks;
  for_each_column(
      [&](auto& column, const auto& other) {
        tasks.emplace_back([&column, size = other.empty() ? 0 : count] { column.resize(size); });
      },
      to, like);
  run(tasks, context);
}

void mark_axes(SampleSet& set, const ExecutionContext& context) {
  parallel_for(context, set.blocks.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      SampleBlock& block = set.blocks[b];
      for (unsigned a = 1; a < 3; ++a) {
        const auto first = std::partition_point(set.edge.begin() + block.begin, set.edge.begin() + block.end,
                                                [&](EdgeCode e) { return e.axis() < a; });
        block.axis_begin[a - 1] = static_cast<std::uint32_t>(first - set.edge.begin());
      }
    }
  });
}

void sum_area(SampleSet& set, const ExecutionContext& context) {
  struct Sums {
    double area = 0, weight = 0;
  };
  std::vector<Sums> sums(set.blocks.size());
  const std::span<const float> weight = set.weights();
  parallel_for(context, set.blocks.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::uint32_t i = set.blocks[b].begin; i < set.blocks[b].end; ++i) {
        sums[b].area += set.area[i];
        sums[b].weight += weight[i];
      }
  });
  set.total_area = set.total_weight = 0;
  for (const Sums& sum : sums) {
    set.total_area += sum.area;
    set.total_weight += sum.weight;
  }
}

SampleSet gather(const SampleSet& set, std::span<const std::uint32_t> index, const ExecutionContext& context) {
  SampleSet rest;
  rest.grid = set.grid;
  rest.disagreements = set.disagreements;
  rest.unresolved = set.unresolved;
  rest.cut_by_bounds = set.cut_by_bounds;
  rest.total_area = set.total_area;
  rest.total_weight = set.total_weight;
  const std::span<const float> weight = set.weights();
  std::uint32_t kept = 0;
  for (const SampleBlock& block : set.blocks) {
    SampleBlock made{kept, kept, block.brick, {}};
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) made.axis_begin[static_cast<std::size_t>(axis) - 1] = kept;
      for (std::uint32_t i = block.begin_of_axis(axis); i < block.end_of_axis(axis); ++i) {
        if (kept < index.size() && index[kept] == i) {
          ++kept;
        } else {
          rest.total_area -= set.area[i];
          rest.total_weight -= weight[i];
        }
      }
    }
    made.end = kept;
    if (made.end > made.begin) rest.blocks.push_back(made);
  }
  if (kept != index.size()) throw std::logic_error("gather: indices must ascend and lie in blocks");
  resize_like(rest, set, index.size(), context);
  for_each_column(
      [&](const auto& from, auto& to) {
        parallel_for(context, to.size(), 65536, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) to[i] = from[index[i]];
        });
      },
      set, rest);
  return rest;
}

SampleSet part_of(const SampleSet& whole, std::span<const std::uint32_t> blocks, const ExecutionContext& context) {
  SampleSet part;
  part.grid = whole.grid;
  part.total_area = whole.total_area;
  part.total_weight = whole.total_weight;
  part.cut_by_bounds = whole.cut_by_bounds;
  std::vector<std::uint64_t> keys, chosen, around;
  for (const SampleBlock& block : whole.blocks)
    keys.push_back(morton_code(block.brick[0], block.brick[1], block.brick[2]));
  std::uint32_t count = 0;
  for (const std::uint32_t b : blocks) {
    SampleBlock block = whole.blocks[b];
    const std::uint32_t shift = block.begin - count;
    for (std::uint32_t* at : {&block.begin, &block.end, &block.axis_begin[0], &block.axis_begin[1]}) *at -= shift;
    count = block.end;
    part.blocks.push_back(block);
    chosen.push_back(keys[b]);
    for (int n = 0; n < 27; ++n) {
      const int x = block.brick[0] + n % 3 - 1, y = block.brick[1] + n / 3 % 3 - 1, z = block.brick[2] + n / 9 - 1;
      if (std::min({x, y, z}) >= 0) around.push_back(morton_code(std::uint64_t(x), std::uint64_t(y), std::uint64_t(z)));
    }
  }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  for (const std::uint64_t key : around)
    if (!std::binary_search(chosen.begin(), chosen.end(), key) && std::binary_search(keys.begin(), keys.end(), key))
      part.left_out.push_back(key);
  resize_like(part, whole, count, context);
  parallel_for(context, blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const SampleBlock& from = whole.blocks[blocks[b]];
      copy_samples(whole, from.begin, from.end, part, part.blocks[b].begin);
    }
  });
  return part;
}

}  // namespace evenmesh
