#pragma once
/// Sampled surfaces and seeds for the tests of cells, optimization and connection.

#include <cmath>
#include <vector>

#include "core/random.h"
#include "cvt/cells.h"
#include "cvt/relax.h"
#include "cvt/starts.h"
#include "geometry/primitives.h"
#include "grid/sample_checks.h"

namespace evenmesh {

inline std::vector<Vec3> positions_of(const SampleSet& samples) {
  std::vector<Vec3> points(samples.size());
  for (const SampleBlock& block : samples.blocks)
    for (std::size_t i = block.begin; i < block.end; ++i) points[i] = position(samples, block, i);
  return points;
}

/// Seeds somewhere near the surface: drawn by area, then shaken by `amplitude` (model units).
inline std::vector<Vec3> perturbed_seeds(const SampleSet& samples, std::size_t count, double amplitude,
                                         std::uint64_t seed) {
  std::vector<Vec3> seeds = random_start(samples, count, seed);
  Random random(seed + 100);
  for (Vec3& s : seeds) {
    const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
    s += amplitude * Vec3{x, y, z};
  }
  return seeds;
}

inline std::vector<Vec3> relaxed_seeds(const SampleSet& samples, std::size_t count, std::size_t evaluations = 40) {
  ExecutionContext context(1);
  CpuCellEvaluator evaluator(samples, context);
  return relax_seeds(evaluator, count, {.evaluations = evaluations}, context).seeds.positions;
}

/// Mean distance between neighbouring seeds, about.
inline double spacing_of(const SampleSet& samples, std::size_t seeds) {
  return std::sqrt(samples.total_area / static_cast<double>(seeds));
}

}  // namespace evenmesh
