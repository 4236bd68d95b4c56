#include "grid/sample_set.h"

#include <cmath>

#include "evenmesh/error.h"

namespace evenmesh {
namespace {

constexpr std::size_t max_resolution = 8192;

// Where the bounds' lower corner lies in its cell. Three different, irrational-looking fractions, so that symmetric
// models and round coordinates do not fall onto grid planes, nor onto diagonals of cells.
constexpr double offset[3] = {0.3819660113, 0.7071067812, 0.5436890127};
constexpr double margin = 2.0;  // cells

std::uint32_t to_unorm16(double v) {
  return static_cast<std::uint32_t>(std::floor((v * 0.5 + 0.5) * 65534.0 + 0.5));
}
double from_unorm16(std::uint32_t v) {
  return v * (2.0 / 65534.0) - 1.0;
}
double sign_of(double v) {
  return v < 0 ? -1.0 : 1.0;
}

}  // namespace

Grid make_grid(const Box& bounds, std::size_t resolution) {
  if (bounds.empty() || !is_finite(bounds.lo) || !is_finite(bounds.hi) || !(bounds.longest_side() > 0))
    throw InvalidInput("the bounds are empty or not finite: give a box with finite corners and at least one side > 0");
  if (resolution < 1 || resolution > max_resolution)
    throw InvalidInput("resolution " + std::to_string(resolution) + " is out of range: choose 1 to 8192");
  Grid grid;
  grid.spacing = bounds.longest_side() / static_cast<double>(resolution);
  if (!(grid.spacing > 0) || !std::isfinite(1.0 / grid.spacing))
    throw InvalidInput("the bounds are too small for a grid: scale the model up");
  for (int a = 0; a < 3; ++a) {
    const double before = margin + offset[a];
    grid.origin[a] = bounds.lo[a] - before * grid.spacing;
    const double cells = (bounds.hi[a] - bounds.lo[a]) / grid.spacing + before + margin;
    grid.size[static_cast<std::size_t>(a)] = static_cast<std::uint32_t>(std::ceil(cells)) + 1;
  }
  return grid;
}

PackedNormal pack_normal(const Vec3& unit) {
  const double sum = std::abs(unit.x) + std::abs(unit.y) + std::abs(unit.z);
  const double scale = sum > 0 ? 1.0 / sum : 0.0;
  double u = unit.x * scale, v = unit.y * scale;
  if (unit.z < 0) {
    const double folded = (1.0 - std::abs(v)) * sign_of(u);
    v = (1.0 - std::abs(u)) * sign_of(v);
    u = folded;
  }
  return {to_unorm16(u) | to_unorm16(v) << 16};
}

Vec3 unpack_normal(PackedNormal packed) {
  double u = from_unorm16(packed.bits & 0xffff), v = from_unorm16(packed.bits >> 16);
  const double z = 1.0 - std::abs(u) - std::abs(v);
  if (z < 0) {
    const double unfolded = (1.0 - std::abs(v)) * sign_of(u);
    v = (1.0 - std::abs(u)) * sign_of(v);
    u = unfolded;
  }
  return normalized({u, v, z});
}

PackedNormal opposite(PackedNormal n) {
  const int u = static_cast<int>(n.bits & 0xffff) - 32767, v = static_cast<int>(n.bits >> 16) - 32767;
  // Turning z over folds the square's corners; the sign of what is folded stays that of u and v, here negated.
  const int fu = (32767 - std::abs(v)) * (u < 0 ? 1 : -1), fv = (32767 - std::abs(u)) * (v < 0 ? 1 : -1);
  return {static_cast<std::uint32_t>(fu + 32767) | static_cast<std::uint32_t>(fv + 32767) << 16};
}

}  // namespace evenmesh
