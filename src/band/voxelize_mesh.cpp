// Triangles are binned by bricks of 16³ voxels, in the same exact way in which they then mark the voxels of a brick.

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "band/site_parts.h"
#include "band/triangle_cells.h"
#include "band/voxelize.h"
#include "evenmesh/error.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

constexpr std::size_t triangles_per_piece = 4096;

/// A mesh in voxels, snapped to the lattice.
struct SnappedMesh {
  const Mesh& mesh;
  const VoxelGrid& grid;
  int bits = 16;
  std::vector<LatticePoint> points;

  LatticeTriangle corners(std::size_t triangle) const {
    const Triangle& t = mesh.triangles[triangle];
    return {points[t[0]], points[t[1]], points[t[2]]};
  }
};

SnappedMesh snap(const Mesh& mesh, const VoxelGrid& grid, const ExecutionContext& context) {
  check_mesh(mesh, context);
  SnappedMesh snapped{mesh, grid, 16, {}};
  const Box box = mesh.bounds();
  double reach = 0;
  for (int a = 0; a < 3 && !box.empty(); ++a)
    reach = std::max({reach, std::abs(box.lo[a] - grid.origin[a]) / grid.side,
                      std::abs(box.hi[a] - grid.origin[a]) / grid.side, double(grid.size[std::size_t(a)])});
  while (snapped.bits > 0 && std::ldexp(reach, snapped.bits) > largest_lattice_coordinate) --snapped.bits;
  if (!(std::ldexp(reach, snapped.bits) <= largest_lattice_coordinate))
    throw InvalidInput("the mesh is too large for the grid: enlarge its bounds or lower the resolution");
  snapped.points = snap_vertices(mesh, grid.origin, grid.side, snapped.bits, context);
  return snapped;
}

CellBox all_cells(const VoxelGrid& grid, int bits) {
  CellBox box;
  for (std::size_t a = 0; a < 3; ++a) box[a] = {0, (static_cast<std::int32_t>(grid.size[a]) - 1) >> bits};
  return box;
}

bool is_within(const LatticeTriangle& corners, const VoxelGrid& grid, int bits) {
  for (const LatticePoint& p : corners)
    for (std::size_t a = 0; a < 3; ++a)
      if (p[a] < 0 || p[a] > std::int64_t{grid.size[a]} << bits) return false;
  return true;
}

/// Pairs of a brick and a triangle that touches it: brick_key(), sorted.
std::vector<std::uint64_t> bin_triangles(const SnappedMesh& snapped, std::size_t& outside,
                                         const ExecutionContext& context) {
  const std::size_t count = snapped.mesh.triangles.size(),
                    pieces = (count + triangles_per_piece - 1) / triangles_per_piece;
  std::vector<std::vector<std::uint64_t>> found(pieces);
  std::atomic<std::size_t> cut{0};
  const CellBox bricks = all_cells(snapped.grid, brick_bits);
  parallel_for(context, pieces, 1, [&](std::size_t begin, std::size_t end) {
    TriangleCells touched;
    for (std::size_t piece = begin; piece < end; ++piece)
      for (std::size_t t = piece * triangles_per_piece; t < std::min(count, (piece + 1) * triangles_per_piece); ++t) {
        const LatticeTriangle corners = snapped.corners(t);
        if (!is_within(corners, snapped.grid, snapped.bits)) cut.fetch_add(1, std::memory_order_relaxed);
        touched.set(corners, snapped.bits + brick_bits, bricks);
        touched.for_each([&](const Voxel& brick) { found[piece].push_back(brick_key(brick, t)); });
      }
  });
  outside = cut.load();
  std::vector<std::uint64_t> pairs;
  std::size_t total = 0;
  for (const auto& list : found) total += list.size();
  pairs.reserve(total);
  for (auto& list : found) {
    pairs.insert(pairs.end(), list.begin(), list.end());
    std::vector<std::uint64_t>().swap(list);
  }
  parallel_sort(context, pairs);
  return pairs;
}

/// The nearest surface point so far of one voxel; everything in voxels, relative to its centre.
struct NearestSurface {
  float squared_distance = std::numeric_limits<float>::infinity();
  float x = 0, y = 0, z = 0;
  std::uint32_t source = 0;
};
using Sites = BrickSites<NearestSurface>;

/// Distances of points to the plane of a triangle and to its edges' lines within the plane; in float, but from values
/// near the brick that were computed in double.
class TriangleFrame {
 public:
  /// @param corners  in voxels, relative to the centre of the brick's first voxel
  explicit TriangleFrame(const std::array<Vec3, 3>& corners) : corners_(corners) {
    const auto& [a, b, c] = corners;
    const Vec3 normal = normalized(area_normal(a, b, c));
    axes_[0] = axis(normal, a);
    axes_[1] = axis(normalized(cross(normal, b - a)), a);
    axes_[2] = axis(normalized(cross(normal, c - b)), b);
    axes_[3] = axis(normalized(cross(normal, a - c)), c);
  }

  /// Of each voxel centre: height[i] above the plane, and how far its foot lies within the triangle (negative: beyond
  /// an edge). Both 0 for degenerate triangles, which so rule nothing out.
  void measure(std::span<const std::uint32_t> voxels, float* height, float* within) const {
    const Axis n = axes_[0], e = axes_[1], f = axes_[2], g = axes_[3];
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      const auto v = static_cast<std::int32_t>(voxels[i]);
      const auto x = static_cast<float>(v & (brick_voxels - 1));
      const auto y = static_cast<float>(v >> brick_bits & (brick_voxels - 1));
      const auto z = static_cast<float>(v >> (2 * brick_bits));
      const float p = e.x * x + e.y * y + e.z * z - e.at, q = f.x * x + f.y * y + f.z * z - f.at,
                  r = g.x * x + g.y * y + g.z * z - g.at;
      const float least = p < q ? p : q;
      height[i] = n.x * x + n.y * y + n.z * z - n.at;
      within[i] = least < r ? least : r;
    }
  }

  /// Replaces the site's point by the triangle's when that is nearer.
  void offer(std::uint32_t voxel, float height, float within, std::uint32_t source, NearestSurface& site) const {
    const float height2 = height * height;
    if (within > 0) {
      const Axis& n = axes_[0];
      if (height2 < site.squared_distance) site = {height2, -height * n.x, -height * n.y, -height * n.z, source};
      return;
    }
    // What lies beyond an edge's line is at least that far away; the slack is for rounding.
    if (height2 + within * within > site.squared_distance * 1.00001f + 1e-5f) return;
    const Vec3 center{double(voxel % brick_voxels), double(voxel >> brick_bits & (brick_voxels - 1)),
                      double(voxel >> (2 * brick_bits))};
    const Vec3 offset = closest_point_on_triangle(center, corners_[0], corners_[1], corners_[2]) - center;
    const auto squared = static_cast<float>(squared_norm(offset));
    if (squared < site.squared_distance) site = {squared, float(offset.x), float(offset.y), float(offset.z), source};
  }

 private:
  struct Axis {
    float x, y, z, at;  // where the point through which it goes lies along it
  };
  static Axis axis(const Vec3& unit, const Vec3& through) {
    return {float(unit.x), float(unit.y), float(unit.z), float(dot(unit, through))};
  }

  std::array<Vec3, 3> corners_;
  std::array<Axis, 4> axes_;
};

/// Marks the voxels of one brick after the other.
class BrickVoxelizer {
 public:
  explicit BrickVoxelizer(const SnappedMesh& snapped) : snapped_(snapped), whole_(all_cells(snapped.grid, 0)) {}

  void voxelize(const BrickItems& brick, SitePart& part) {
    CellBox box;
    for (std::size_t a = 0; a < 3; ++a)
      box[a] = CellRange{brick.corner[a], brick.corner[a] + brick_voxels - 1}.cut(whole_[a]);
    for (const std::uint64_t key : brick.keys) add(static_cast<std::uint32_t>(key), brick.corner, box);
    const auto h = static_cast<float>(snapped_.grid.side);
    const std::size_t first = part.x.size(), size = first + sites_.size();
    part.x.resize(size);
    part.y.resize(size);
    part.z.resize(size);
    part.source.resize(size);
    sites_.finish(brick.corner, part, [&](std::size_t i, const NearestSurface& site) {
      part.x[first + i] = h * site.x;
      part.y[first + i] = h * site.y;
      part.z[first + i] = h * site.z;
      part.source[first + i] = site.source;
    });
  }

 private:
  static constexpr std::size_t voxels = std::size_t{1} << (3 * brick_bits);

  void add(std::uint32_t triangle, const Voxel& corner, const CellBox& box) {
    touched_.set(snapped_.corners(triangle), snapped_.bits, box);
    std::size_t count = 0;
    touched_.for_each(
        [&](const Voxel& v) { voxels_[count++] = Sites::local(v[0] - corner[0], v[1] - corner[1], v[2] - corner[2]); });
    std::array<Vec3, 3> corners = corners_of(snapped_.mesh, triangle);
    const Vec3 first{corner[0] + 0.5, corner[1] + 0.5, corner[2] + 0.5};
    for (Vec3& p : corners) p = (p - snapped_.grid.origin) * (1.0 / snapped_.grid.side) - first;
    const TriangleFrame frame(corners);
    frame.measure(std::span(voxels_).first(count), height_.data(), within_.data());
    for (std::size_t i = 0; i < count; ++i)
      frame.offer(voxels_[i], height_[i], within_[i], triangle, sites_.at(voxels_[i]));
  }

  const SnappedMesh& snapped_;
  CellBox whole_;
  TriangleCells touched_;
  std::vector<std::uint32_t> voxels_ = std::vector<std::uint32_t>(voxels);  // that one triangle touches
  std::vector<float> height_ = std::vector<float>(voxels), within_ = std::vector<float>(voxels);
  Sites sites_;
};

std::vector<PackedNormal> triangle_normals(const SnappedMesh& snapped, const ExecutionContext& context) {
  std::vector<PackedNormal> normals(snapped.mesh.triangles.size());
  parallel_for(context, normals.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      // In voxels, so that small models do not underflow.
      std::array<Vec3, 3> p = corners_of(snapped.mesh, t);
      for (Vec3& q : p) q = (q - snapped.grid.origin) * (1.0 / snapped.grid.side);
      normals[t] = pack_normal(normalized(area_normal(p[0], p[1], p[2])));
    }
  });
  return normals;
}

}  // namespace

SiteVoxels voxelize_mesh(const Mesh& mesh, const VoxelGrid& grid, ExecutionContext& context) {
  return with_threads(context, [&] {
    const SnappedMesh snapped = snap(mesh, grid, context);
    std::size_t outside = 0;
    const std::vector<std::uint64_t> pairs = bin_triangles(snapped, outside, context);
    const std::vector<BrickItems> bricks = bricks_of(pairs);
    SiteVoxels sites = collect_sites(grid, bricks, context, [&](std::span<const BrickItems> some, SitePart& part) {
      BrickVoxelizer voxelizer(snapped);
      for (const BrickItems& brick : some) voxelizer.voxelize(brick, part);
    });
    sites.outside = outside;
    const std::vector<PackedNormal> normals = triangle_normals(snapped, context);
    sites.normal.resize(sites.size());
    parallel_for(context, sites.size(), 65536, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) sites.normal[i] = normals[sites.source[i]];
    });
    return sites;
  });
}

}  // namespace evenmesh
