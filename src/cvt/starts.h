#pragma once
/// Where seeds start.

#include <cstdint>
#include <span>
#include <vector>

#include "cvt/cells.h"
#include "grid/seeds.h"

namespace evenmesh {

/// `count` samples drawn by their share in the vertices, the area where all is even (with replacement on few samples).
/// [Raster2Mesh §4.1]
std::vector<Vec3> random_start(const SampleSet& samples, std::size_t count, std::uint64_t seed);

/// `count` samples spread by elimination: from several times as many random ones those with the most crowded
/// neighbourhood go first (Yuksel, Sample elimination for generating Poisson disk sample sets, CGF 2015), near being
/// measured in wanted edge lengths. Cost: O(count log count).
std::vector<Vec3> blue_noise_start(const SampleSet& samples, std::size_t count, std::uint64_t seed);

/// A place on the surface in the middle of every pair of neighbouring cells. With new seeds there they are about four
/// times as many, and wherever the seeds lie in a hexagonal pattern the new ones continue it: irregular vertices do not
/// multiply.
/// @param evaluator  samples, about 100 per seed or more, so that short borders between cells are seen
std::vector<Vec3> neighbour_middles(CellEvaluator& evaluator, const std::vector<Vec3>& seeds,
                                    ExecutionContext& context);

/// Adds seeds at random samples of the cells with the largest share (their area where all is even), or removes the
/// seeds of those with the smallest, until there are exactly `count`. Fixed ones stay. Seeds that stay keep
/// their order; balance them afterwards.
/// @pre  count ≥ the number of fixed ones
void adjust_count(CellEvaluator& evaluator, Seeds& seeds, std::size_t count, std::uint64_t seed,
                  ExecutionContext& context);

/// `fixed`, all of which are, followed by those others that are not nearer than `reach` to one of them.
Seeds fixed_and_others(Seeds fixed, std::span<const Vec3> others, double reach);

}  // namespace evenmesh
