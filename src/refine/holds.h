#pragma once
/// What refinement must leave as it is: vertices and edges on creases.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace evenmesh {

struct Holds {
  std::vector<char> vertices;                       ///< by vertex, 1: does not move; empty: all may
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< lower vertex first, sorted: are not flipped

  bool vertex(std::uint32_t v) const { return v < vertices.size() && vertices[v] != 0; }
  bool edge(std::uint32_t a, std::uint32_t b) const {
    return vertex(a) && vertex(b) &&
           std::binary_search(edges.begin(), edges.end(), std::array{std::min(a, b), std::max(a, b)});
  }
};

}  // namespace evenmesh
