#pragma once
/// How a shape will be sampled, and how fine.

#include <algorithm>
#include <optional>
#include <vector>

#include "evenmesh/findings.h"
#include "evenmesh/mesh_shape.h"
#include "pipeline/sampler.h"
#include "pipeline/stage_timer.h"

namespace evenmesh {

enum class Route {
  solid,   ///< rays through a solid
  sheets,  ///< the shell around a surface: both its sides are sampled, one becomes the mesh
  wrap     ///< the solid that a shell encloses
};

struct Plan {
  Route route = Route::solid;
  std::size_t vertices = 0;
  VoxelPlan grid;                        ///< of solids the resolution alone
  bool refinable = true;                 ///< the resolution was not asked for: a finer grid may be taken
  std::optional<double> mean_thickness;  ///< of closed meshes, model units
  double samples_per_h2 = 0;             ///< solids: samples that are expected, times the squared spacing
  std::size_t small_components = 0;      ///< solids: seen so far
  std::vector<Finding> findings;
};

/// Samples per seed: wanted, and the least (|S| ≤ |P|/α, [Raster2Mesh §4.1]).
inline constexpr double wanted_alpha = 100, min_alpha = 50;
inline constexpr double cells_across_wall = 1.5;  ///< of the grid that thin walls and gaps need
inline constexpr double affordable_alpha = 400;   ///< samples per seed that a grid made finer for their sake may have,
/// or some millions altogether: seconds.
inline double affordable_samples(double vertices) {
  return std::max(affordable_alpha * vertices, 4e6);
}
/// To two digits.
double round_up(double count);
inline constexpr std::size_t max_resolution = 8192;
inline constexpr unsigned max_thickness = 20;  ///< voxels

/// Vertex count asked for, or estimated: edges turn by about 20° where the surface is curved most, and are no longer
/// than thin parts are thick; the grid so that every seed has 100 samples and thin parts have cells inside.
/// @throws InvalidInput   rays for points or wraps
/// @throws UnusableInput  no surface within the bounds, or none that has an area
Plan make_plan(const Sampler& sampler, const MeshOptions& options, StageTimer& timer, ExecutionContext& context);

}  // namespace evenmesh
