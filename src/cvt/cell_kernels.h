#pragma once
/// SIMD kernels of CellEvaluator: one block of samples against its candidate seeds.

#include <cstddef>
#include <cstdint>

namespace evenmesh {

/// Samples of a block and its candidate seeds, all relative to the block's centre. At least one seed.
struct BlockView {
  const float *x, *y, *z;
  const float *area, *weight;  ///< size of the footprint and what it counts; the same array where all is even
  float footprint;             ///< a sample of area a has a footprint of radius footprint / √max(a, min_area)
  float min_area;
  std::size_t samples;
  const float *seed_x, *seed_y, *seed_z;  ///< readable up to a multiple of eight
  std::size_t seeds;
};

/// Box of a block's samples relative to its centre.
struct BlockBox {
  float center[3], half[3];
};

/// Leaves out the seeds that cannot be among the two nearest of any point of the box, even when every seed moves by its
/// margin (null: none moves): those for which two others are nearer everywhere in it. Coordinates relative to the
/// block's centre, arrays of a capacity rounded up to eight; keeps the order. Returns how many are left.
std::size_t keep_near_seeds(const BlockBox& box, const float* margin, float* x, float* y, float* z, std::uint32_t* seed,
                            std::size_t count);

/// Seeds that may come among the two nearest of a point within `radius` of the centre when each moves by its margin.
struct SeedsInReach {
  std::size_t count = 0;  ///< their positions are in `hits`, ascending
  float limit = 0;        ///< a seed that is farther than this plus its margin cannot; huge with fewer than two seeds
};
/// Arrays readable, and `scratch` writable, up to a multiple of eight.
SeedsInReach seeds_in_reach(const float center[3], float radius, const float* x, const float* y, const float* z,
                            const float* margin, std::size_t count, float* scratch, std::uint32_t* hits);

/// Per candidate seed: Σ w, Σ w·(x − s).
struct BlockSums {
  float *mass, *mx, *my, *mz;
};

/// Floats of scratch that evaluate_block needs per candidate seed.
inline constexpr std::size_t lane_sums_per_seed = 32;

/// Mass and first moments about each seed, footprints cut by bisectors; returns the block's energy.
double evaluate_block(const BlockView& block, float* lane_sums, const BlockSums& sums);

/// Position in the candidate list of the nearest seed of every sample, first one on ties.
void nearest_in_block(const BlockView& block, std::uint32_t* nearest);

/// The two nearest, and the distance to their bisector (first == second, distance large, when there is one seed only).
void nearest_pair_in_block(const BlockView& block, std::uint32_t* first, std::uint32_t* second,
                           float* bisector_distance);

}  // namespace evenmesh
