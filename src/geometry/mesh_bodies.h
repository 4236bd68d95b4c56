#pragma once
/// The closed bodies of a mesh, and which way they face.

#include <cstdint>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

struct MeshBody {
  std::vector<std::uint32_t> triangles;
  Box box;
  double volume = 0;  ///< model units cubed; below zero where it faces inward
};

/// Triangles by the number of their body.
std::vector<MeshBody> bodies_of(const Mesh& mesh, const std::vector<std::uint32_t>& number);

/// The bodies that face inward, overlap another one that faces outward, and do not lie within one; with what lies
/// within them. Turned around they add to the solid what else they would take from it.
std::vector<std::size_t> inverted_bodies(const Mesh& mesh, const std::vector<MeshBody>& bodies);

}  // namespace evenmesh
