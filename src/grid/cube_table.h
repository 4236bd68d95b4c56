#pragma once
/// How the crossings on the twelve edges of a grid cube close up into loops.

#include <array>
#include <cstdint>

namespace evenmesh {

/// Corners are numbered x + 2y + 4z. Edge 4·axis + a + 2b starts at the corner whose two other coordinates, in the
/// order x, y, z, are (a, b), and runs along `axis`.
struct CubeLoops {
  std::uint8_t count = 0;               ///< loops, at most 4
  std::array<std::uint8_t, 5> start{};  ///< loop l is edges start[l] … start[l + 1] − 1
  std::array<std::uint8_t, 12> edge{};  ///< cyclic, counter-clockwise seen from outside the solid
  /// Bit e: edge[e] and the next of its loop lie on a face towards lower coordinates. Of the two cubes that see such a
  /// pair of edges it is so for one.
  std::uint16_t lower_links = 0;
};

/// Loops for each of the 256 patterns of inside corners (bit c set: corner c is inside).
///
/// Two crossings on a face belong together; of four, those around each inside corner do: inside cells that touch only
/// along an edge or at a corner are separated, so that the surface through all loops is two-manifold.
const std::array<CubeLoops, 256>& cube_loops();

/// Inside corners for a set of crossed edges, given that corner 0 is outside (bit e set: edge e is crossed); 0 if that
/// set is impossible.
const std::array<std::uint8_t, 4096>& corners_of_crossed_edges();

}  // namespace evenmesh
