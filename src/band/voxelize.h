#pragma once
/// The voxels that a surface touches, each with a point of the surface: the sites of a shell.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "band/voxel_grid.h"
#include "band/voxel_tiles.h"
#include "evenmesh/execution_context.h"
#include "grid/sample_set.h"
#include "shape/field.h"

namespace evenmesh {

/// Site voxels, in the order of their tiles; structure of arrays, one entry per site.
struct SiteVoxels {
  VoxelGrid grid;
  VoxelTiles tiles;
  std::vector<float> x, y, z;         ///< the surface point relative to the voxel's centre, model units
  std::vector<PackedNormal> normal;   ///< unit; oriented as the input is; empty for points without normals
  std::vector<std::uint32_t> source;  ///< triangle of the input mesh; empty for points, fields and samples
  std::size_t outside = 0;            ///< triangles or points that lie outside the grid, at least in part: cut there

  std::size_t size() const { return x.size(); }
  /// Memory of the arrays and tiles.
  std::size_t bytes() const;
};

/// The voxels that the triangles of a mesh touch.
///
/// The surface point is the point of the touching triangles that is nearest to the voxel's centre, of several (compared
/// in single precision) the one on the lowest triangle. It lies within √3/2 voxels of the centre: near edges of the
/// surface perhaps in a neighbouring voxel, but always on the surface. Any triangles will do: open, intersecting, of
/// either orientation, degenerate ones (their normal is arbitrary).
/// Guarantee: vertices are snapped to a lattice of 2^-16 voxels, coarser when they lie more than 11,585 voxels away
/// from the grid's origin; then the closed voxels that a closed triangle touches, exactly (see TriangleCells): none is
/// missed, a triangle in the face of two voxels marks both. Same bytes for any number of threads.
/// Cost: O(triangles + sites), about 0.1 µs per pair of a triangle and a voxel; while it runs, 16 bytes per triangle,
/// 12 per vertex and 16 per site more than the result.
/// @throws InvalidInput  an index is out of range, a coordinate not finite or 7·10^8 voxels away, or there are more
/// than 4 billion sites
SiteVoxels voxelize_mesh(const Mesh& mesh, const VoxelGrid& grid,
                         ExecutionContext& context = ExecutionContext::silent());

/// The voxels that hold a point of a cloud; a point on a face belongs to the upper voxel.
///
/// The surface point is the mean of the points in the voxel, the normal that of theirs. Cost: O(points · log points).
/// @param normals  one per point, not all of them zero, or none
/// @throws InvalidInput  as many normals as points are needed, or none; a point or normal is not finite
SiteVoxels voxelize_points(std::span<const Vec3> points, std::span<const Vec3> normals, const VoxelGrid& grid,
                           ExecutionContext& context = ExecutionContext::silent());

/// The voxels on whose twelve edges the samples of a surface lie: the cells of the samples' grid that the surface
/// crosses.
///
/// The surface point is the mean of the samples on the voxel's edges, the normal that of theirs. The voxels of a closed
/// surface separate inside from outside. Cost: O(samples).
/// @param margin  voxels between the samples' grid and the border of the voxels', 0 to 64; d − 1 or more for a shell
/// that reaches d voxels
SiteVoxels voxelize_samples(const SampleSet& samples, unsigned margin,
                            ExecutionContext& context = ExecutionContext::silent());

/// The voxels on whose edges a field changes its sign, within `bounds` (empty: the grid's).
///
/// Interval arithmetic prunes what f does not reach, so the cost goes with the surface: see sample_shape().
/// Surface points and normals as voxelize_samples().
SiteVoxels voxelize_field(const Field& field, const VoxelGrid& grid, const Box& bounds = {},
                          ExecutionContext& context = ExecutionContext::silent());

}  // namespace evenmesh
