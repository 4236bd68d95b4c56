#pragma once
/// Disjoint sets over indices.

#include <cstdint>
#include <vector>

namespace evenmesh {

/// The set's smallest index; shortens the path on the way.
inline std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// The smaller root becomes the root of both, so that roots do not depend on the order of unions.
inline void unite(std::vector<std::uint32_t>& parent, std::uint32_t a, std::uint32_t b) {
  a = find_root(parent, a), b = find_root(parent, b);
  if (a < b)
    parent[b] = a;
  else
    parent[a] = b;
}

}  // namespace evenmesh
