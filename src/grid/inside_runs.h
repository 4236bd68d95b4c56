#pragma once
/// Which grid points are inside, from the crossings alone.

#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// The runs of inside points along the rays of x. Keeps no reference to the samples.
/// Memory: 4 bytes per ray and 2 per crossing of x.
class InsideRuns {
 public:
  /// @param samples  of a solid: entering and leaving in turn along every ray
  /// Cost: about 10 ns per sample.
  InsideRuns(const SampleSet& samples, const ExecutionContext& context);

  /// Whether grid point (i, j, k) is inside; points beyond the grid are not. Cost: a load or two.
  bool operator()(std::int32_t i, std::int32_t j, std::int32_t k) const {
    if (i < 0 || j < 0 || k < 0 || std::uint32_t(j) >= size_[1] || std::uint32_t(k) >= size_[2]) return false;
    const std::size_t ray = std::size_t(k) * size_[1] + std::size_t(j);
    std::uint32_t below = 0;  // crossings below the point
    for (std::uint32_t c = begin_[ray]; c < begin_[ray + 1] && cell_[c] < i; ++c) ++below;
    return below % 2 != 0;
  }

 private:
  std::array<std::uint32_t, 3> size_{};
  std::vector<std::uint32_t> begin_;
  std::vector<std::uint16_t> cell_;
};

}  // namespace evenmesh
