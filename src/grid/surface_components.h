#pragma once
/// Connected pieces of a sampled surface.

#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

struct SurfaceParts {
  std::vector<std::uint32_t> part;  ///< of every sample, numbered from 0 by first sample
  std::vector<double> area;         ///< of every part, model units squared
};
/// Cost: about 50 ns per sample.
SurfaceParts surface_parts(const SampleSet& samples, Run& run);

/// The volume within every part, from its crossings along x, in cells of the grid. Cavities come out negative.
std::vector<double> volumes_within(const SurfaceParts& parts, const SampleSet& samples);

/// Leaves out the parts with less than `least_area`; returns how many.
std::size_t drop_dust(SampleSet& samples, double least_area, Run& run);

/// Fills what the outside does not reach: cavities go, with all that lies in them. Returns how many parts of surface
/// that were. Cost: as surface_parts().
std::size_t fill_cavities(SampleSet& samples, Run& run);

}  // namespace evenmesh
