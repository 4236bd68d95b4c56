#pragma once
/// Triangle meshes with defects, put in order before they are sampled.

#include <cstddef>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// What cleaned() did, and what is left to be healed by sampling.
struct MeshDefects {
  std::size_t welded_vertices = 0;  ///< vertices at the place of another one, joined with it
  std::size_t degenerate_triangles =
      0;  ///< with two corners in one place, or without area and joining no others: left out
  std::size_t repeated_triangles = 0;  ///< with the same corners as another one: left out
  std::size_t wall_triangles = 0;      ///< of walls that two touching bodies share: left out
  std::size_t turned_triangles = 0;    ///< that faced other ways than most around them
  std::size_t non_manifold_edges = 0;  ///< with three triangles or more: kept
  std::size_t boundary_edges = 0;      ///< with one triangle: kept
  std::size_t patches = 0;             ///< connected across edges of two triangles
};

/// The mesh with one vertex for equal points, without degenerate and repeated triangles, each patch facing one way:
/// that of most of its triangles, by area.
///
/// A patch that cannot face one way (a Möbius band) is turned as far as possible. Where two bodies touch in triangles
/// with the same corners these go, so that the bodies become one. Guarantee: no coordinate changes; unused vertices are
/// left out. Cost: about 1 µs per triangle.
/// @throws InvalidInput  a triangle's index is out of range
Mesh cleaned(const Mesh& mesh, MeshDefects& defects);

/// The mesh with its holes filled: every closed walk of at most 400 boundary edges gets the triangles of least area
/// that it bounds.
///
/// A fill must lie about half way between inside and outside, by the generalized winding number. So two rims that face
/// each other across a gap, as of a part torn in two, stay open, and what rays say bridges them.
/// @param filled  how many holes were filled
/// Guarantee: vertices, and the triangles given, stay as they are. Cost: n³ ns for a hole of n edges, and some 30 ns
/// for every hole and triangle of a fill; where these are more than 10^8 pairs, as in soups, none is filled.
/// @throws InvalidInput  a triangle's index is out of range
Mesh holes_filled(const Mesh& mesh, std::size_t& filled);

/// How much of an inside a mesh has: of the points that rays of any of three directions call inside, the share on which
/// all three agree. 1 for closed meshes, 0.9 with some holes, below a half for open sheets; 0 if no ray finds an
/// inside.
///
/// Asked at 64 points along the longest side; a closed mesh that has none of them inside, as a thin plate, is solid if
/// it has a volume. Cost: some milliseconds and about 0.2 µs per triangle.
double solidity(const Mesh& mesh, ExecutionContext& context = ExecutionContext::silent());

/// Solidity below which there is no inside to speak of: sheets.
inline constexpr double min_solidity = 0.6;

}  // namespace evenmesh
