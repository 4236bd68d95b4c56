#include "grid/inside_runs.h"

#include <algorithm>

namespace evenmesh {

InsideRuns::InsideRuns(const SampleSet& samples, const ExecutionContext& context) : size_(samples.grid.size) {
  begin_.assign(std::size_t(size_[1]) * size_[2] + 1, 0);
  const auto each = [&](const auto& visit) {
    for (const SampleBlock& block : samples.blocks)
      for (std::uint32_t s = block.begin_of_axis(0); s < block.end_of_axis(0); ++s) {
        const EdgeCode edge = samples.edge[s];
        const std::size_t j = block.brick[1] * brick_size + edge.j(), k = block.brick[2] * brick_size + edge.k();
        visit(k * size_[1] + j, static_cast<std::uint16_t>(block.brick[0] * brick_size + edge.i()));
      }
  };
  each([&](std::size_t ray, std::uint16_t) { ++begin_[ray + 1]; });
  for (std::size_t r = 1; r < begin_.size(); ++r) begin_[r] += begin_[r - 1];
  cell_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  each([&](std::size_t ray, std::uint16_t cell) { cell_[next[ray]++] = cell; });
  parallel_for(context, begin_.size() - 1, 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) std::sort(cell_.begin() + begin_[r], cell_.begin() + begin_[r + 1]);
  });
}

}  // namespace evenmesh
