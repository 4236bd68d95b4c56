#include "band/enclosed.h"

#include <algorithm>

#include "band/narrow_band.h"
#include "evenmesh/error.h"
#include "grid/blocks.h"
#include "grid/combine.h"
#include "grid/morton.h"
#include "grid/surface_components.h"

namespace evenmesh {
namespace {

/// Voxels around the points of the samples' grid, with whole bricks of margin.
VoxelGrid voxels_around(const Grid& grid, unsigned bricks) {
  const double margin = double(bricks * brick_size);
  VoxelGrid voxels;
  voxels.side = grid.spacing;
  voxels.origin = grid.point(-margin - 0.5, -margin - 0.5, -margin - 0.5);
  for (std::size_t a = 0; a < 3; ++a) voxels.size[a] = grid.size[a] + 2 * bricks * brick_size;
  return voxels;
}

SiteVoxels voxels_of(const SampleSet& samples, const VoxelGrid& grid, ExecutionContext& context) {
  std::vector<Vec3> points(samples.size()), normals(samples.size());
  for (const SampleBlock& block : samples.blocks)
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
      points[i] = samples.block_center(block) + Vec3{samples.x[i], samples.y[i], samples.z[i]};
      normals[i] = unpack_normal(samples.normal[i]);
    }
  return voxelize_points(points, normals, grid, context);
}

}  // namespace

SiteVoxels outer_border(const BandSurface& surface, const Sheets& outer, const VoxelGrid& grid,
                        ExecutionContext& context) {
  const SampleSet& samples = surface.samples;
  std::vector<Vec3> points, normals;
  for (const SampleBlock& block : samples.blocks)
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
      if (!outer.chosen[i]) continue;
      points.push_back(samples.block_center(block) + Vec3{samples.x[i], samples.y[i], samples.z[i]});
      normals.push_back(unpack_normal(samples.normal[i]));
    }
  return voxelize_points(points, normals, grid, context);
}

SampleSet enclosed_by(const BandSurface& surface, ExecutionContext& context) {
  const SurfaceComponents parts = surface_components(surface.samples, context);
  std::vector<double> behind(parts.area.size(), 0);
  for (std::uint32_t i = 0; i < surface.samples.size(); ++i)
    if (surface.facing[i] < 0) behind[parts.part[i]] += surface.samples.area[i];
  const auto is_inner = [&](std::uint32_t i) { return behind[parts.part[i]] > 0.5 * parts.area[parts.part[i]]; };
  SampleSet samples = keep_samples(surface.samples, is_inner, context);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.edge[i].bits ^= 1;
    samples.normal[i] = pack_normal(-unpack_normal(samples.normal[i]));
  }
  return samples;
}

SampleSet narrow_gaps_filled(const SampleSet& solid, unsigned reach, ExecutionContext& context) {
  if (reach < 1 || reach > 10) throw InvalidInput("gaps can be filled by balls of 1 to 10 cells");
  const unsigned margin = (2 * reach + 2 + brick_size - 1) / brick_size;
  const VoxelGrid grid = voxels_around(solid.grid, margin);
  const SiteVoxels sites = voxels_of(solid, grid, context);
  const BandSurface grown = band_surface(build_narrow_band(sites, reach, context), sites, context);
  const SiteVoxels border = outer_border(grown, outer_sheets(grown, context), grid, context);
  SampleSet core =
      enclosed_by(band_surface(build_narrow_band(border, reach + (reach + 1) / 2, context), border, context), context);
  core.grid = solid.grid;
  core.source.clear();
  for (SampleBlock& block : core.blocks)
    for (std::uint16_t& brick : block.brick) brick = static_cast<std::uint16_t>(brick - margin);
  std::sort(core.blocks.begin(), core.blocks.end(), [](const SampleBlock& a, const SampleBlock& b) {
    return morton_code(a.brick[0], a.brick[1], a.brick[2]) < morton_code(b.brick[0], b.brick[1], b.brick[2]);
  });
  return combine(solid, core, Boolean::unite, context);
}

}  // namespace evenmesh
