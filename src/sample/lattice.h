#pragma once
/// A triangle mesh on the integer lattice of a grid, and which triangles touch which slab of rays.

#include <array>
#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "evenmesh/mesh.h"
#include "grid/sample_set.h"

namespace evenmesh {

using LatticePoint = std::array<std::int32_t, 3>;

/// 2^29.5: no coordinate is larger, so that differences stay below 2^30.5.
inline constexpr double largest_lattice_coordinate = 759250124.0;

/// @throws InvalidInput  a triangle's index is out of range, or a coordinate that it uses is not finite
void check_mesh(const Mesh& mesh, const ExecutionContext& context);

/// Vertices in units of 2^-bits · spacing from `origin`, rounded to nearest. What is out of range becomes 0.
std::vector<LatticePoint> snap_vertices(const Mesh& mesh, const Vec3& origin, double spacing, int bits,
                                        const ExecutionContext& context);

/// Triangles per slab, CSR.
struct SlabBins {
  std::vector<std::uint32_t> begin, triangles;
};

/// Vertices in units of 2^-bits cells from the grid's origin. All differences stay below 2^30.6, so that products of
/// two fit into 64 bits, and a plane equation into 128.
struct Lattice {
  int bits = 16;
  std::vector<LatticePoint> points;
  bool closed = false;   ///< the triangles' boundary is empty: every edge used equally often both ways
  bool clipped = false;  ///< the mesh leaves the bounds
  std::array<std::int32_t, 3> first{}, last{};  ///< grid points that may be inside, inclusive; first > last: none
  std::array<double, 3> face_lo{}, face_hi{};   ///< bounds in cells from the grid's origin
  std::array<SlabBins, 3> bins;

  std::int32_t cells_up(std::int32_t v) const { return (v + ((1 << bits) - 1)) >> bits; }
};

/// Snaps, checks and bins. Empty bounds: those of the grid, less its outermost cells.
/// @throws InvalidInput  an index is out of range, a coordinate is not finite, the mesh does not fit the grid and its
/// bounds
Lattice make_lattice(const Mesh& mesh, const Grid& grid, const Box& bounds, const ExecutionContext& context);

}  // namespace evenmesh
