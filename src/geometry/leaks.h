#pragma once
/// Holes in what bounds a solid all the same, and what is open on purpose.

#include <cstdint>
#include <functional>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// How much of an inside rays find: solidity(), which modules above know.
using AskRays = std::function<double(const Mesh&)>;

struct Leaks {
  std::vector<std::vector<Triangle>> fills;  ///< of the holes that are to be filled
  std::vector<char> leaking;  ///< by triangle: of a patch that has an inside, but keeps a hole that cannot be filled
};

/// Patches whose holes are all to be filled: they have at most a quarter of the patch's area, and none is a mouth
/// (hole_room.h). Of others of which rays of three directions agree on an inside (solidity() of 0.6 and more) those
/// holes whose fills lie half way between inside and outside.
/// @param patch  of every triangle; patches that share the rim of a hole count as one
/// Cost: that of hole_fills(); of patches with more than 1/100 of the area, some milliseconds.
Leaks find_leaks(const Mesh& mesh, const std::vector<std::uint32_t>& patch, const AskRays& solidity,
                 ExecutionContext& context);

/// The mesh of some triangles, without the vertices that they do not use.
Mesh packed(const std::vector<Vec3>& vertices, std::vector<Triangle> triangles);

}  // namespace evenmesh
