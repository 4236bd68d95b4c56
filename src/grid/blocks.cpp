#include "grid/blocks.h"

#include <algorithm>
#include <limits>

#include "evenmesh/error.h"

namespace evenmesh {

void resize_samples(SampleSet& set, std::size_t count, bool with_sources, const ExecutionContext& context) {
  if (count > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput("more than 4 billion samples: lower the resolution");
  parallel_tasks(context, 7, [&](std::size_t i) {
    switch (i) {
      case 0:
        set.x.resize(count);
        break;
      case 1:
        set.y.resize(count);
        break;
      case 2:
        set.z.resize(count);
        break;
      case 3:
        set.area.resize(count);
        break;
      case 4:
        set.normal.resize(count);
        break;
      case 5:
        set.edge.resize(count);
        break;
      default:
        set.source.resize(with_sources ? count : 0);
    }
  });
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
  std::vector<double> sums(set.blocks.size());
  parallel_for(context, set.blocks.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::uint32_t i = set.blocks[b].begin; i < set.blocks[b].end; ++i) sums[b] += set.area[i];
  });
  set.total_area = 0;
  for (const double sum : sums) set.total_area += sum;
}

}  // namespace evenmesh
