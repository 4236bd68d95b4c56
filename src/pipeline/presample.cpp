#include "pipeline/presample.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "grid/surface_components.h"

namespace evenmesh {
namespace {

constexpr std::size_t presample_cells = 96;
constexpr double min_cells_across = 1.2;  ///< thinner parts may lie between the grid points

struct Pairs {
  std::vector<std::pair<float, float>> curvature, thickness;  ///< (value, area)
};

/// Compares each sample of a block with a few others of it.
void compare_samples(const SampleSet& samples, const SampleBlock& block, Pairs& pairs) {
  const double h = samples.grid.spacing;
  const auto position = [&](std::uint32_t i) { return Vec3{samples.x[i], samples.y[i], samples.z[i]}; };
  for (std::uint32_t i = block.begin; i < block.end; i += 3) {
    const Vec3 n = unpack_normal(samples.normal[i]), p = position(i);
    double bend = -1, nearest_back = std::numeric_limits<double>::infinity();
    for (std::uint32_t j = block.begin; j < block.end; j += 2) {
      if (j == i) continue;
      const Vec3 m = unpack_normal(samples.normal[j]), d = position(j) - p;
      const double distance = norm(d), facing = dot(n, m);
      // The same sheet, two to four cells apart: far enough for the angle to mean something.
      if (facing > 0.2 && distance > 1.8 * h && distance < 4 * h && std::abs(dot(d, n)) < 0.5 * distance)
        bend = std::max(bend, norm(n - m) / distance);
      // The other side of the solid: behind the sample and facing away.
      if (facing < -0.7 && dot(d, n) < -0.7 * distance) nearest_back = std::min(nearest_back, distance);
    }
    if (bend >= 0) pairs.curvature.push_back({static_cast<float>(bend), samples.area[i]});
    pairs.thickness.push_back({static_cast<float>(nearest_back), samples.area[i]});
  }
}

/// The value below which `share` of the area lies.
double quantile(std::vector<std::pair<float, float>>& values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  double total = 0, passed = 0;
  for (const auto& v : values) total += v.second;
  for (const auto& v : values)
    if ((passed += v.second) >= share * total) return v.first;
  return values.back().first;
}

}  // namespace

SurfaceScale measure_scale(const SampleSet& coarse, ExecutionContext& context) {
  std::vector<Pairs> of_chunk((coarse.blocks.size() + 63) / 64);
  parallel_tasks(context, of_chunk.size(), [&](std::size_t c) {
    for (std::size_t b = 64 * c; b < std::min(coarse.blocks.size(), 64 * (c + 1)); ++b)
      compare_samples(coarse, coarse.blocks[b], of_chunk[c]);
  });
  Pairs all;
  for (const Pairs& p : of_chunk) {
    all.curvature.insert(all.curvature.end(), p.curvature.begin(), p.curvature.end());
    all.thickness.insert(all.thickness.end(), p.thickness.begin(), p.thickness.end());
  }
  const double h = coarse.grid.spacing, bend = quantile(all.curvature, 0.9);
  SurfaceScale scale;
  scale.area = coarse.total_area;
  scale.samples_per_area = static_cast<double>(coarse.size()) * h * h / coarse.total_area;
  scale.curvature_radius = bend > 0 ? 1 / bend : std::numeric_limits<double>::infinity();
  scale.thickness = quantile(all.thickness, 0.02);
  return scale;
}

namespace {

std::size_t count_small_components(const SampleSet& samples, ExecutionContext& context) {
  const double small_component = 8 * samples.grid.spacing * samples.grid.spacing;
  const auto parts = surface_components(samples, context);
  return static_cast<std::size_t>(
      std::count_if(parts.area.begin(), parts.area.end(), [&](double a) { return a < small_component; }));
}

}  // namespace

SurfaceScale presample(const Sampler& sampler, std::size_t finest, ExecutionContext& context) {
  finest = std::max(finest, 4 * presample_cells);
  for (std::size_t cells = presample_cells;; cells *= 2) {
    const bool last = 2 * cells > finest;
    try {
      const SampleSet samples = sampler.sample(make_grid(sampler.bounds(), cells), context);
      SurfaceScale scale = measure_scale(samples, context);
      scale.small_components = count_small_components(samples, context);
      if (last || scale.thickness > min_cells_across * samples.grid.spacing) return scale;
    } catch (const UnusableInput&) {
      if (last) throw;
    }
  }
}

}  // namespace evenmesh
