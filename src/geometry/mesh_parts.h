#pragma once
/// A triangle mesh taken apart into what bounds a solid and what does not.

#include <optional>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "geometry/leaks.h"

namespace evenmesh {

/// Something found in a mesh: how many triangles, where, how large.
struct MeshPiece {
  Vec3 middle;      ///< of its box
  double size = 0;  ///< diagonal of its box, model units
  double area = 0;  ///< squared model units
};

struct MeshParts {
  Mesh solid;   ///< what bounds a solid, closed as far as it can be; no triangle if nothing does
  Mesh sheets;  ///< what lies beside, at least in part outside: fins, open sheets, surfaces of which both sides are
                ///< shown
  std::vector<MeshPiece> sheet_pieces, filled_holes, turned_bodies;  ///< each largest first
  std::size_t turned_triangles = 0;                                  ///< that faced other ways than those around them
  bool as_given = false;  ///< the mesh as it is bounds the solid: `solid` is empty then
};

/// Tells solids from sheets, part by part.
///
/// Patches with a free boundary bound nothing, unless their holes are few and small: such holes are filled. A hole is
/// small if with the others of its patch it has at most a quarter of the patch's area and is no mouth (hole_room.h), or
/// if rays of three directions agree on the patch's inside (solidity()). What is left are closed bodies. One that faces
/// inward and does not lie within another is turned, since it would take away what it overlaps; cavities stay, of
/// models that are inside out as a whole, too.
/// @param turn  false: bodies stay as they face
/// Guarantee: no coordinate changes. Cost: about 0.1 µs per triangle where all is in order, 3 µs otherwise.
/// @throws InvalidInput  a triangle's index is out of range
MeshParts parts_of(const Mesh& mesh, bool turn, const AskRays& solidity, ExecutionContext& context);

}  // namespace evenmesh
