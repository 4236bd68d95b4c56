#pragma once
/// Seeds of cells, and which of them stay where they are.

#include <cstdint>
#include <span>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// What a fixed seed stays on.
struct Attachment {
  enum class Kind : std::uint8_t { corner, curve };
  Kind kind = Kind::corner;
  std::uint32_t index = 0;  ///< of the corner or the curve
  friend bool operator==(const Attachment&, const Attachment&) = default;
};

/// The fixed seeds come first. Labels are indices of seeds.
struct Seeds {
  std::vector<Vec3> positions;
  std::vector<Attachment> fixed;  ///< of the first seeds; the others are free

  Seeds() = default;
  /// Free ones.
  Seeds(std::vector<Vec3> free) : positions(std::move(free)) {}
  Seeds(std::vector<Vec3> all, std::vector<Attachment> first) : positions(std::move(all)), fixed(std::move(first)) {}

  std::size_t size() const { return positions.size(); }
  bool is_fixed(std::size_t seed) const { return seed < fixed.size(); }
  std::span<const Vec3> fixed_positions() const { return std::span(positions).first(fixed.size()); }
  std::span<const Vec3> free_positions() const { return std::span(positions).subspan(fixed.size()); }
  operator std::span<const Vec3>() const { return positions; }
};

}  // namespace evenmesh
