#pragma once
/// Morton codes of bricks.

#include <array>
#include <cstdint>

namespace evenmesh {

/// Spreads the lowest 21 bits of v to every third bit.
inline std::uint64_t spread_bits(std::uint64_t v) {
  v = (v | v << 32) & 0x001f00000000ffffull;
  v = (v | v << 16) & 0x001f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}

/// Every third bit of v, from the lowest, gathered.
inline std::uint64_t gather_bits(std::uint64_t v) {
  v &= 0x1249249249249249ull;
  v = (v | v >> 2) & 0x10c30c30c30c30c3ull;
  v = (v | v >> 4) & 0x100f00f00f00f00full;
  v = (v | v >> 8) & 0x001f0000ff0000ffull;
  v = (v | v >> 16) & 0x001f00000000ffffull;
  return (v | v >> 32) & 0x1fffffull;
}

/// x in the lowest bit of each triple.
inline std::uint64_t morton_code(std::uint64_t i, std::uint64_t j, std::uint64_t k) {
  return spread_bits(i) | spread_bits(j) << 1 | spread_bits(k) << 2;
}

inline std::array<std::uint16_t, 3> morton_decode(std::uint64_t code) {
  return {static_cast<std::uint16_t>(gather_bits(code)), static_cast<std::uint16_t>(gather_bits(code >> 1)),
          static_cast<std::uint16_t>(gather_bits(code >> 2))};
}

}  // namespace evenmesh
