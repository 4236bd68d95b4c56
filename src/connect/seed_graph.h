#pragma once
/// What samples tell about the seeds around them.

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

inline constexpr std::size_t largest_group = 8;
inline constexpr std::uint32_t no_seed = 0xffffffffu;
/// Seeds that one sample has within ε of its nearest, ascending, filled up with no_seed.
using SeedGroup = std::array<std::uint32_t, largest_group>;

/// All lists sorted, nothing in them twice.
struct SeedGraph {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> delaunay;    ///< first < second: the two nearest of a sample
  std::vector<std::pair<std::uint32_t, std::uint32_t>> candidates;  ///< first < second, never the two nearest
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< ascending: the three nearest of a sample, all within ε
  std::vector<SeedGroup> groups;                      ///< of four seeds and more; the nearest ones of more than eight
  std::vector<std::uint32_t> nearest;                 ///< seed of each sample, ties to the lower index
};

/// @param margin  ε, model units
/// Guarantee: exact up to the rounding of distances in double precision; same for any number of threads.
/// Based on [Raster2Mesh §4.3].
SeedGraph seed_graph(const SampleSet& samples, std::span<const Vec3> seeds, double margin, ExecutionContext& context);

}  // namespace evenmesh
