#pragma once
/// Samples of a surface on the edges of one common grid, in blocks that are compact in space.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "evenmesh/mesh.h"
#include "grid/thin_spots.h"

namespace evenmesh {

/// Cubic grid. Grid point (i, j, k) lies at origin + spacing · (i, j, k), 0 ≤ i < size[0], …
///
/// The outermost layer of points is always outside the solid. A *ray* of axis a runs through the grid points that share
/// their two other coordinates; a *grid edge* joins two neighbouring points of a ray.
struct Grid {
  Vec3 origin;
  double spacing = 1;                   ///< h, model units
  std::array<std::uint32_t, 3> size{};  ///< grid points along each axis, at most 8,200

  Vec3 point(double i, double j, double k) const { return origin + spacing * Vec3{i, j, k}; }
};

/// Grid around `bounds` with `resolution` cells along the longest side and at least two cells of margin on every side.
Grid make_grid(const Box& bounds, std::size_t resolution);

/// Unit vector in 32 bits: octahedral map (Meyer et al., On floating-point normal vectors, EGSR 2010), error below
/// 7e-5.
struct PackedNormal {
  std::uint32_t bits = 0;
};
PackedNormal pack_normal(const Vec3& unit);
Vec3 unpack_normal(PackedNormal packed);
/// Exactly −n, and twice that is n again (except for the poles' many codes).
PackedNormal opposite(PackedNormal n);

/// Where a sample lies in its block: axis of the grid edge, cell of its lower end within the brick, which end is
/// inside.
struct EdgeCode {
  std::uint16_t bits = 0;
  EdgeCode() = default;
  EdgeCode(unsigned axis, unsigned i, unsigned j, unsigned k, bool lower_end_inside)
      : bits(static_cast<std::uint16_t>(axis << 10 | i << 7 | j << 4 | k << 1 | (lower_end_inside ? 1u : 0u))) {}
  unsigned axis() const { return bits >> 10; }
  unsigned i() const { return bits >> 7 & 7; }
  unsigned j() const { return bits >> 4 & 7; }
  unsigned k() const { return bits >> 1 & 7; }
  bool lower_end_inside() const { return bits & 1; }
};

/// Grid points per side of a brick: a block holds the samples whose edges start in one brick.
inline constexpr unsigned brick_size = 8;

/// Area that a sample on a ray of `axis` stands for: h²·|n_axis|.
///
/// The rays of one axis alone hit the surface once per h²/|n_a| of area, evenly spaced. Counting that with the share
/// n_a², which add up to 1 over the axes, gives three quadratures that are each smooth and together exact, where equal
/// shares h²/(|nx|+|ny|+|nz|) let grazing rays count as much as steep ones.
inline double sample_area(const Vec3& unit_normal, int axis, double spacing) {
  return spacing * spacing * std::abs(unit_normal[axis]);
}

struct SampleBlock {
  std::uint32_t begin = 0, end = 0;           ///< range of samples, those on x rays first, then y, then z
  std::array<std::uint16_t, 3> brick{};       ///< brick coordinates: grid point / brick_size
  std::array<std::uint32_t, 2> axis_begin{};  ///< where the samples on y rays and on z rays begin

  std::uint32_t begin_of_axis(int axis) const {
    return axis == 0 ? begin : axis_begin[static_cast<std::size_t>(axis) - 1];
  }
  std::uint32_t end_of_axis(int axis) const { return axis == 2 ? end : axis_begin[static_cast<std::size_t>(axis)]; }
};

/// What is known of each sample: columns of one length. Those marked optional are empty where they say nothing.
struct SampleColumns {
  std::vector<float> x, y, z;  ///< position relative to SampleSet::block_center(), model units
  std::vector<float> area;     ///< piece of surface a sample stands for, see sample_area(); model units squared
  /// Optional, empty: equal to the area. What the energy of cells counts a sample by, area · (ē / edge)⁴: `edge` is the
  /// edge length wanted here, ē that of an even mesh with as many vertices (weigh_by_density() says why). Model units
  /// squared.
  std::vector<float> weight;
  std::vector<PackedNormal> normal;   ///< unit, outward
  std::vector<EdgeCode> edge;         ///< of a coarsened set: where it lies there; several samples may share one
  std::vector<std::uint32_t> source;  ///< optional: triangle of the input mesh

  std::size_t size() const { return x.size(); }
  bool even() const { return weight.empty(); }
  std::span<const float> weights() const { return even() ? area : weight; }
  /// The sample's share of the vertices: its area times the vertices wanted per area here compared with the mean, that
  /// is √(area · weight). Shares add up to the total area.
  double share(std::size_t i) const {
    return even() ? double(area[i]) : std::sqrt(double(area[i]) * double(weight[i]));
  }
};

template <typename Visit, typename Column, typename... Columns>
void visit_column(const Visit& visit, Column column, Columns&... of) {
  visit(of.*column...);
}
/// The list of all columns, the only one: calls visit(a.x, b.x, …), visit(a.y, b.y, …), … for one or more objects with
/// SampleColumns. Whatever copies samples goes through here (grid/blocks.h).
template <typename Visit, typename... Columns>
void for_each_column(const Visit& visit, Columns&... of) {
  const auto each = [&](auto... column) { (visit_column(visit, column, of...), ...); };
  each(&SampleColumns::x, &SampleColumns::y, &SampleColumns::z, &SampleColumns::area, &SampleColumns::weight,
       &SampleColumns::normal, &SampleColumns::edge, &SampleColumns::source);
}

/// Crossings of the surface with the edges of a grid, at most one per edge; structure of arrays.
///
/// Blocks are sorted by the Morton code of their brick (x the lowest bit), samples in a block by edge code. A value:
/// once made it stays as it is, and what changes samples returns another set.
struct SampleSet : SampleColumns {
  Grid grid;
  std::vector<SampleBlock> blocks;
  double total_area = 0;          ///< Σ area, model units squared
  double total_weight = 0;        ///< Σ weights(), model units squared; at least the area
  std::size_t disagreements = 0;  ///< grid points whose inside differed between directions, settled by vote
  std::size_t unresolved = 0;     ///< crossings left out because one grid edge held several (features thinner than h)
  std::vector<ThinSpot> thin;     ///< walls and gaps thinner than a cell; what changes samples leaves them out
  bool cut_by_bounds = false;     ///< the solid reached the bounds and was closed there
  /// Of a part (part_of() in grid/blocks.h): Morton codes of the bricks next to it whose samples are not in it,
  /// ascending. Cubes there are not walked.
  std::vector<std::uint64_t> left_out{};

  Vec3 block_center(const SampleBlock& b) const {
    constexpr double half = brick_size / 2.0;
    return grid.point(b.brick[0] * double(brick_size) + half, b.brick[1] * double(brick_size) + half,
                      b.brick[2] * double(brick_size) + half);
  }
};

}  // namespace evenmesh
