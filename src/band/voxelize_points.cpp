// Sites with mean points: of clouds, and of samples on grid edges.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>

#include "band/site_parts.h"
#include "band/voxelize.h"
#include "evenmesh/error.h"
#include "sample/field_parts.h"

namespace evenmesh {
namespace {

/// Sums over the points of a voxel, in ascending order of the points.
struct MeanSite {
  Vec3 points, normals;  // points in voxels, relative to the voxel's centre
  std::uint32_t count = 0;

  void add(const Vec3& point, const Vec3& normal) {
    points += point;
    normals += normal;
    ++count;
  }
};

/// Where a point lies, in voxels from the grid's origin.
Vec3 in_voxels(const Vec3& point, const VoxelGrid& grid) {
  return (point - grid.origin) * (1.0 / grid.side);
}
Vec3 center_in_voxels(const Voxel& v) {
  return {v[0] + 0.5, v[1] + 0.5, v[2] + 0.5};
}
Voxel brick_of(const Voxel& v) {
  return {v[0] >> brick_bits, v[1] >> brick_bits, v[2] >> brick_bits};
}

/// The site of a voxel of the brick at `corner`; nullptr for voxels of other bricks.
MeanSite* site_of(BrickSites<MeanSite>& sites, const Voxel& v, const Voxel& corner) {
  const std::int32_t i = v[0] - corner[0], j = v[1] - corner[1], k = v[2] - corner[2];
  if ((i | j | k) >> brick_bits != 0) return nullptr;
  return &sites.at(BrickSites<MeanSite>::local(i, j, k));
}

void finish(BrickSites<MeanSite>& sites, const Voxel& corner, double side, bool with_normals, SitePart& part) {
  const std::size_t first = part.x.size(), size = first + sites.size();
  part.x.resize(size);
  part.y.resize(size);
  part.z.resize(size);
  part.normal.resize(with_normals ? size : 0);
  sites.finish(corner, part, [&](std::size_t i, const MeanSite& site) {
    const Vec3 mean = site.points * (side / site.count);
    part.x[first + i] = static_cast<float>(mean.x);
    part.y[first + i] = static_cast<float>(mean.y);
    part.z[first + i] = static_cast<float>(mean.z);
    if (with_normals) part.normal[first + i] = pack_normal(normalized(site.normals));
  });
}

void check_points(std::span<const Vec3> points, std::span<const Vec3> normals, const ExecutionContext& context) {
  if (!normals.empty() && normals.size() != points.size())
    throw InvalidInput(std::to_string(points.size()) + " points come with " + std::to_string(normals.size()) +
                       " normals: give each point one, or none");
  if (points.size() > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput("more than 4 billion points: thin them out");
  parallel_for(context, points.size(), 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!is_finite(points[i]) || (!normals.empty() && !is_finite(normals[i])))
        throw InvalidInput("point " + std::to_string(i) + " is not finite: remove it");
  });
}

/// The voxel that holds a point; one that is not in the grid for points outside.
Voxel voxel_of(const Vec3& point, const VoxelGrid& grid) {
  const Vec3 p = in_voxels(point, grid);
  Voxel v{};
  for (int a = 0; a < 3; ++a)
    v[std::size_t(a)] =
        static_cast<std::int32_t>(std::floor(std::clamp(p[a], -1.0, double(grid.size[std::size_t(a)]))));
  return v;
}

/// Bricks with their points, sorted; points outside the grid are left out.
std::vector<std::uint64_t> bin_points(std::span<const Vec3> points, const VoxelGrid& grid,
                                      const ExecutionContext& context) {
  constexpr std::uint64_t outside = ~std::uint64_t{0};
  std::vector<std::uint64_t> keys(points.size());
  parallel_for(context, points.size(), 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Voxel v = voxel_of(points[i], grid);
      keys[i] = grid.contains(v) ? brick_key(brick_of(v), i) : outside;
    }
  });
  parallel_sort(context, keys);
  keys.erase(std::lower_bound(keys.begin(), keys.end(), outside), keys.end());
  return keys;
}

/// The first of the four cells around an edge, and the axes across it.
struct EdgeCells {
  Voxel first;
  std::size_t p, q;
};

/// The cells around the grid edge of a sample are its own, and those below it across the edge.
EdgeCells cells_around(const SampleBlock& block, EdgeCode edge) {
  const auto at = [&](std::size_t a, unsigned local) {
    return static_cast<std::int32_t>(block.brick[a] * brick_size + local);
  };
  const std::size_t axis = edge.axis();
  EdgeCells cells{{at(0, edge.i()), at(1, edge.j()), at(2, edge.k())}, axis == 0 ? 1u : 0u, axis == 2 ? 1u : 2u};
  --cells.first[cells.p];
  --cells.first[cells.q];
  return cells;
}

/// Bricks with the blocks whose samples may mark their voxels, sorted.
std::vector<std::uint64_t> bin_blocks(const SampleSet& samples, const VoxelGrid& grid, unsigned margin,
                                      const ExecutionContext& context) {
  std::vector<std::uint64_t> keys;
  for (std::size_t b = 0; b < samples.blocks.size(); ++b) {
    Voxel first{}, last{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto corner = static_cast<std::int32_t>(samples.blocks[b].brick[a] * brick_size + margin);
      first[a] = std::max(corner - 1, 0) >> brick_bits;
      last[a] = (std::min(corner + std::int32_t(brick_size), std::int32_t(grid.size[a])) - 1) >> brick_bits;
    }
    for (std::int32_t k = first[2]; k <= last[2]; ++k)
      for (std::int32_t j = first[1]; j <= last[1]; ++j)
        for (std::int32_t i = first[0]; i <= last[0]; ++i) keys.push_back(brick_key({i, j, k}, b));
  }
  parallel_sort(context, keys);
  return keys;
}

/// Adds the samples of a block to those of the brick's voxels on whose edges they lie.
void add_block(const SampleSet& samples, const SampleBlock& block, const VoxelGrid& grid, unsigned margin,
               const Voxel& corner, BrickSites<MeanSite>& sites) {
  const Vec3 center = samples.block_center(block);
  for (std::uint32_t s = block.begin; s < block.end; ++s) {
    const EdgeCells cells = cells_around(block, samples.edge[s]);
    const Vec3 point = in_voxels(center + Vec3{samples.x[s], samples.y[s], samples.z[s]}, grid);
    const Vec3 normal = unpack_normal(samples.normal[s]);
    for (unsigned c = 0; c < 4; ++c) {
      Voxel v = cells.first;
      v[cells.p] += c & 1;
      v[cells.q] += c >> 1;
      for (std::int32_t& i : v) i += static_cast<std::int32_t>(margin);
      if (!grid.contains(v)) continue;
      if (MeanSite* site = site_of(sites, v, corner)) site->add(point - center_in_voxels(v), normal);
    }
  }
}

SiteVoxels voxelize_on(const SampleSet& samples, const VoxelGrid& grid, unsigned margin,
                       const ExecutionContext& context) {
  const std::vector<std::uint64_t> keys = bin_blocks(samples, grid, margin, context);
  const std::vector<BrickItems> bricks = bricks_of(keys);
  return collect_sites(grid, bricks, context, [&](std::span<const BrickItems> some, SitePart& part) {
    BrickSites<MeanSite> sites;
    for (const BrickItems& brick : some) {
      for (const std::uint64_t key : brick.keys)
        add_block(samples, samples.blocks[static_cast<std::uint32_t>(key)], grid, margin, brick.corner, sites);
      finish(sites, brick.corner, grid.side, true, part);
    }
  });
}

}  // namespace

SiteVoxels voxelize_points(std::span<const Vec3> points, std::span<const Vec3> normals, const VoxelGrid& grid,
                           ExecutionContext& context) {
  return with_threads(context, [&] {
    check_points(points, normals, context);
    const std::vector<std::uint64_t> keys = bin_points(points, grid, context);
    const std::vector<BrickItems> bricks = bricks_of(keys);
    SiteVoxels sites = collect_sites(grid, bricks, context, [&](std::span<const BrickItems> some, SitePart& part) {
      BrickSites<MeanSite> means;
      for (const BrickItems& brick : some) {
        for (const std::uint64_t key : brick.keys) {
          const auto i = static_cast<std::uint32_t>(key);
          const Voxel v = voxel_of(points[i], grid);
          site_of(means, v, brick.corner)
              ->add(in_voxels(points[i], grid) - center_in_voxels(v), normals.empty() ? Vec3{} : normals[i]);
        }
        finish(means, brick.corner, grid.side, !normals.empty(), part);
      }
    });
    sites.outside = points.size() - keys.size();
    return sites;
  });
}

SiteVoxels voxelize_samples(const SampleSet& samples, unsigned margin, ExecutionContext& context) {
  if (margin > 64)
    throw InvalidInput("a margin of " + std::to_string(margin) + " voxels is out of range: choose 0 to 64");
  VoxelGrid grid;
  grid.side = samples.grid.spacing;
  grid.origin = samples.grid.point(-double(margin), -double(margin), -double(margin));
  for (std::size_t a = 0; a < 3; ++a) grid.size[a] = samples.grid.size[a] - 1 + 2 * margin;
  return with_threads(context, [&] { return voxelize_on(samples, grid, margin, context); });
}

SiteVoxels voxelize_field(const Field& field, const VoxelGrid& grid, const Box& bounds, ExecutionContext& context) {
  Grid corners{grid.origin, grid.side, {}};
  for (std::size_t a = 0; a < 3; ++a) corners.size[a] = grid.size[a] + 1;
  return with_threads(context,
                      [&] { return voxelize_on(sample_field(field, corners, bounds, context), grid, 0, context); });
}

}  // namespace evenmesh
