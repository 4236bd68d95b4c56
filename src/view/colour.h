#pragma once
/// Colours as linear light, so that they can be mixed.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Linear red, green, blue in x, y, z, each in [0, 1].
using Colour = Vec3;

inline Colour mix(const Colour& a, const Colour& b, double share_of_b) {
  return (1 - share_of_b) * a + share_of_b * b;
}
inline Colour times(const Colour& a, const Colour& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// From the bytes of sRGB, 0xRRGGBB.
inline Colour from_srgb(std::uint32_t rgb) {
  const auto linear = [](std::uint32_t byte) {
    const double c = byte / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return {linear(rgb >> 16 & 255), linear(rgb >> 8 & 255), linear(rgb & 255)};
}

/// Table look-up: pictures have millions of pixels, and its steps are finer than those of the darkest bytes.
inline std::uint8_t to_srgb_byte(double linear) {
  static const std::array<std::uint8_t, 8192> table = [] {
    std::array<std::uint8_t, 8192> bytes;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      const double c = (static_cast<double>(i) + 0.5) / bytes.size();
      const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
      bytes[i] = static_cast<std::uint8_t>(std::lround(255 * s));
    }
    return bytes;
  }();
  return table[static_cast<std::size_t>(std::clamp(linear * table.size(), 0.0, table.size() - 1.0))];
}

/// Red for 0.5 and less, over yellow, to green for 1.
inline Colour quality_colour(double q) {
  const Colour red = from_srgb(0xc8321f), yellow = from_srgb(0xf7d154), green = from_srgb(0x2f9e62);
  const double t = std::clamp((q - 0.5) / 0.5, 0.0, 1.0);
  return t < 0.5 ? mix(red, yellow, 2 * t) : mix(yellow, green, 2 * t - 1);
}

}  // namespace evenmesh
