#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "sample/field_parts.h"
#include "sample/morton.h"

namespace evenmesh {
namespace {

// Bit k = byte k, for eight bytes of 0 or 1.
unsigned pack_bytes(const std::uint8_t* bytes) {
  std::uint64_t v;
  std::memcpy(&v, bytes, 8);
  return static_cast<unsigned>(v * 0x0102040810204080ull >> 56);
}

struct Marks {
  bool any, all;
};

// Pointers of their own, since bytes may alias anything and the loop is to be vectorized.
Marks mark_inside(const float* __restrict f, std::uint8_t* __restrict inside, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) inside[i] = f[i] < 0.0f ? 1 : 0;
  std::uint8_t any = 0, all = 1;
  for (std::size_t i = 0; i < count; ++i) {
    any = static_cast<std::uint8_t>(any | inside[i]);
    all = static_cast<std::uint8_t>(all & inside[i]);
  }
  return {any != 0, all != 0};
}

}  // namespace

FieldGrid make_field_grid(const Grid& grid, const Box& bounds) {
  FieldGrid result;
  result.grid = grid;
  for (unsigned a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const std::uint32_t n = (grid.size[a] + 31) / 32 * 32 + 1;
    for (std::uint32_t i = 0; i < n; ++i)
      result.coordinate[a].push_back(static_cast<float>(grid.origin[axis] + grid.spacing * i));
    const double top = grid.size[a] - 1.5;
    double lo = 0.5, hi = top;
    if (!bounds.empty()) {
      lo = std::clamp((bounds.lo[axis] - grid.origin[axis]) / grid.spacing, 0.5, top);
      hi = std::clamp((bounds.hi[axis] - grid.origin[axis]) / grid.spacing, 0.5, top);
    }
    result.face_lo[a] = lo, result.face_hi[a] = hi;
    result.first[a] = static_cast<std::int32_t>(std::ceil(lo));
    result.last[a] = static_cast<std::int32_t>(std::floor(hi));
  }
  return result;
}

// Evaluates f at all points of the tile, z fastest; false when all of them are outside, or inside and within the
// bounds.
bool TileScanner::evaluate(const Field& field, const FieldGrid& grid, const std::array<std::uint32_t, 3>& corner,
                           unsigned side) {
  points_ = side + 1;
  const std::size_t count = std::size_t{points_} * points_ * points_;
  x_.resize(count), y_.resize(count), z_.resize(count), f_.resize(count);
  inside_.resize(count + 8);
  // One line along z, then one sheet of lines along y, then all sheets.
  const std::size_t sheet = std::size_t{points_} * points_;
  for (unsigned j = 0; j < points_; ++j) {
    std::copy_n(&grid.coordinate[2][corner[2]], points_, &z_[j * points_]);
    std::fill_n(&y_[j * points_], points_, grid.coordinate[1][corner[1] + j]);
  }
  for (unsigned i = 0; i < points_; ++i) {
    std::fill_n(&x_[i * sheet], sheet, grid.coordinate[0][corner[0] + i]);
    if (i == 0) continue;
    std::copy_n(&y_[0], sheet, &y_[i * sheet]);
    std::copy_n(&z_[0], sheet, &z_[i * sheet]);
  }
  field.evaluate({x_, y_, z_}, f_);
  const auto [any, all] = mark_inside(f_.data(), inside_.data(), count);
  bool within = true;
  for (unsigned a = 0; a < 3; ++a)
    within = within && grid.within(a, static_cast<std::int32_t>(corner[a])) &&
             grid.within(a, static_cast<std::int32_t>(corner[a] + side));
  return any && !(all && within);
}

void TileScanner::scan(const Field& field, const FieldGrid& grid, const std::array<std::uint32_t, 3>& corner,
                       unsigned side, std::vector<Bracket>& brackets, FieldPart& part) {
  if (!evaluate(field, grid, corner, side)) return;
  const std::uint64_t bricks = std::uint64_t{side / 8} * (side / 8) * (side / 8);
  for (std::uint64_t b = 0; b < bricks; ++b) {
    const auto brick = morton_decode(b);
    scan_brick(grid, corner, {brick[0] * 8u, brick[1] * 8u, brick[2] * 8u}, brackets, part);
  }
}

void TileScanner::scan_brick(const FieldGrid& grid, const std::array<std::uint32_t, 3>& corner,
                             const std::array<std::uint32_t, 3>& offset, std::vector<Bracket>& brackets,
                             FieldPart& part) {
  std::array<std::int32_t, 3> start{};
  for (unsigned a = 0; a < 3; ++a) start[a] = static_cast<std::int32_t>(corner[a] + offset[a]);
  unsigned within_k = 0;
  for (int k = 0; k < 9; ++k) within_k |= grid.within(2, start[2] + k) ? 1u << k : 0u;
  const std::size_t stride[3] = {std::size_t{points_} * points_, points_, 1};
  const std::size_t base = offset[0] * stride[0] + offset[1] * stride[1] + offset[2];
  // Inside along z, in the bits of mask[i][j]; points beyond the bounds are outside.
  unsigned mask[9][9];
  bool within_j[9];
  for (int j = 0; j < 9; ++j) within_j[j] = grid.within(1, start[1] + j);
  unsigned any = 0, all = ~0u;
  for (unsigned i = 0; i < 9; ++i) {
    const bool within_i = grid.within(0, start[0] + static_cast<int>(i));
    for (unsigned j = 0; j < 9; ++j) {
      const std::uint8_t* bytes = &inside_[base + i * stride[0] + j * stride[1]];
      const unsigned bits = pack_bytes(bytes) | static_cast<unsigned>(bytes[8]) << 8;
      mask[i][j] = within_i && within_j[j] ? bits & within_k : 0u;
      any |= mask[i][j], all &= mask[i][j];
    }
  }
  if (any == 0 || all == 511) return;
  const std::size_t first = brackets.size();
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned i = 0; i < 8; ++i)
      for (unsigned j = 0; j < 8; ++j) {
        const unsigned here = mask[i][j];
        const unsigned next = axis == 0 ? mask[i + 1][j] : axis == 1 ? mask[i][j + 1] : here >> 1;
        for (unsigned change = (here ^ next) & 255u; change != 0; change &= change - 1) {
          const auto k = static_cast<unsigned>(std::countr_zero(change));
          const std::size_t at = base + i * stride[0] + j * stride[1] + k;
          Bracket bracket;
          bracket.code = EdgeCode(axis, i, j, k, (here >> k & 1) != 0);
          bracket.block = static_cast<std::uint32_t>(part.blocks.size());
          bracket.f_lo = f_[at], bracket.f_hi = f_[at + stride[axis]];
          const unsigned index[3] = {i, j, k};
          const std::int32_t lower = start[axis] + static_cast<std::int32_t>(index[axis]);
          if (!grid.within(axis, lower)) {
            bracket.on_bounds = true, bracket.t_lo = static_cast<float>(grid.face_lo[axis] - lower);
          } else if (!grid.within(axis, lower + 1)) {
            bracket.on_bounds = true, bracket.t_hi = static_cast<float>(grid.face_hi[axis] - lower);
          }
          brackets.push_back(bracket);
        }
      }
  if (brackets.size() == first) return;
  SampleBlock block;
  block.begin = static_cast<std::uint32_t>(first), block.end = static_cast<std::uint32_t>(brackets.size());
  for (unsigned a = 0; a < 3; ++a) block.brick[a] = static_cast<std::uint16_t>(start[a] / 8);
  part.blocks.push_back(block);
}

}  // namespace evenmesh
