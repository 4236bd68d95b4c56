#pragma once
/// Shells around small surfaces, shared by the tests of shells and sheets.

#include <vector>

#include "band/band_surface.h"
#include "band/moving_least_squares.h"
#include "core/random.h"
#include "evenmesh/points.h"
#include "voxel_checks.h"

namespace evenmesh {

struct BandOf {
  SiteVoxels sites;
  NarrowBand band;
  BandSurface surface;
};
inline BandOf band_of(const Mesh& mesh, std::size_t resolution, unsigned reach, unsigned threads = 2) {
  ExecutionContext context(threads);
  BandOf made;
  made.sites = voxelize_mesh(mesh, make_voxel_grid(mesh.bounds(), resolution, reach + 2), context);
  made.band = build_narrow_band(made.sites, reach, context);
  made.surface = band_surface(made.band, made.sites, context);
  return made;
}

/// Calls use(index, position) for all samples.
template <typename Use>
void for_samples(const SampleSet& set, const Use& use) {
  for (const SampleBlock& block : set.blocks)
    for (std::size_t i = block.begin; i < block.end; ++i) use(i, position(set, block, i));
}

/// Calls use(index, surface point) for all sites.
template <typename Use>
void for_sites(const SiteVoxels& sites, const Use& use) {
  const std::vector<Voxel> voxels = voxels_of(sites.tiles);
  for (std::size_t i = 0; i < voxels.size(); ++i) use(i, surface_point(sites, voxels[i], i));
}

/// Random points of the unit sphere.
inline PointCloud ball_of_points(std::size_t count, std::uint64_t seed = 1) {
  Random random(seed);
  PointCloud cloud;
  while (cloud.points.size() < count) {
    const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
    cloud.points.push_back(normalized({x, y, z}));
  }
  return cloud;
}

/// Points of the unit sphere as the shell method bridges them.
struct Bridged {
  SiteVoxels sparse, sites;
  double spacing = 0;
};
/// @param oriented  with the sphere's normals, or with estimated ones
inline Bridged bridged(const PointCloud& cloud, bool oriented, std::size_t resolution, unsigned threads) {
  ExecutionContext context(threads);
  Bridged made;
  made.spacing = point_spacing(cloud, context);
  const double h = cloud.bounds().longest_side() / static_cast<double>(resolution);
  const auto reach = static_cast<unsigned>(std::max(2.0, std::ceil(1.6 * made.spacing / h)));
  const VoxelGrid grid = make_voxel_grid(cloud.bounds(), resolution, reach + 2);
  made.sparse = voxelize_points(cloud.points, oriented ? cloud.points : std::vector<Vec3>{}, grid, context);
  if (!oriented) estimate_normals(made.sparse, 2 * reach, context);
  made.sites = moving_least_squares(made.sparse, build_narrow_band(made.sparse, reach, context), made.spacing, oriented,
                                    context);
  return made;
}

/// Connected sets of voxels outside a shell that do not reach the grid's border.
inline std::size_t cavities_of(const NarrowBand& band) {
  const VoxelGrid& grid = band.grid();
  const auto at = [&](const Voxel& v) {
    return (std::size_t(v[2]) * grid.size[1] + std::size_t(v[1])) * grid.size[0] + std::size_t(v[0]);
  };
  std::vector<char> seen(grid.voxels(), 0);
  std::size_t cavities = 0;
  std::vector<Voxel> stack;
  for_all_voxels(grid, [&](const Voxel& start) {
    if (seen[at(start)] || band.find(start) != nullptr) return;
    bool enclosed = true;
    seen[at(start)] = 1, stack.push_back(start);
    while (!stack.empty()) {
      const Voxel v = stack.back();
      stack.pop_back();
      for (std::size_t a = 0; a < 3; ++a)
        for (const int step : {-1, 1}) {
          Voxel next = v;
          next[a] += step;
          if (!grid.contains(next)) {
            enclosed = false;
          } else if (!seen[at(next)] && band.find(next) == nullptr) {
            seen[at(next)] = 1, stack.push_back(next);
          }
        }
    }
    cavities += enclosed;
  });
  return cavities;
}

}  // namespace evenmesh
