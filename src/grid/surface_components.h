#pragma once
/// Connected pieces of a sampled surface.

#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

struct SurfaceComponents {
  std::vector<std::uint32_t> part;  ///< of every sample, numbered from 0 by first sample
  std::vector<double> area;         ///< of every part, model units squared
};
/// Cost: about 50 ns per sample.
SurfaceComponents surface_components(const SampleSet& samples, ExecutionContext& context);

/// The volume within every part, from its crossings along x, in cells of the grid. Cavities come out negative.
std::vector<double> volumes_within(const SurfaceComponents& parts, const SampleSet& samples);

/// What is left of a surface.
struct RemainingSurface {
  SampleSet samples;
  std::size_t dropped = 0;  ///< components that went; 0: the samples are those given
};

/// Leaves out components that are too small for one cell: those with less than `min_area` (model units squared), both
/// of area and of share in the vertices. Where a density asks for more, a smaller component counts, too.
RemainingSurface drop_small_components(SampleSet samples, double min_area, ExecutionContext& context);

/// Fills what the outside does not reach: cavities go, with all that lies in them. Cost: as surface_components().
RemainingSurface fill_cavities(SampleSet samples, ExecutionContext& context);

}  // namespace evenmesh
