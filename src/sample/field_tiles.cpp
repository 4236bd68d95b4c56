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

bool FieldGrid::within(const GridCube& cube) const {
  bool all = true;
  for (unsigned a = 0; a < 3; ++a)
    all = all && within(a, static_cast<std::int32_t>(cube.corner[a])) &&
          within(a, static_cast<std::int32_t>(cube.corner[a] + cube.side));
  return all;
}

// Points beyond the bounds are outside, so of them only those are needed at which an edge ends.
TileScanner::Tile TileScanner::tile_of(const GridCube& cube, const FieldGrid& grid) {
  Tile tile;
  tile.cube = cube;
  for (unsigned a = 0; a < 3; ++a) {
    const auto corner = static_cast<std::int32_t>(cube.corner[a]);
    const std::int32_t skipped = std::max(grid.first[a] - 1 - corner, 0) / 8 * 8;
    const std::int32_t top = std::min(corner + static_cast<std::int32_t>(cube.side), grid.last[a] + 1);
    tile.start[a] = static_cast<std::uint32_t>(corner + skipped);
    tile.points[a] = static_cast<std::uint32_t>(std::max(top - corner - skipped + 1, 1));
  }
  return tile;
}

// Lays out as many cubes as one evaluation takes; returns the number of their points.
std::size_t TileScanner::collect(const FieldGrid& grid, std::span<const GridCube> cubes, std::size_t batch) {
  tiles_.clear();
  std::size_t count = 0;
  for (const GridCube& cube : cubes) {
    Tile tile = tile_of(cube, grid);
    if (!tiles_.empty() && count + tile.count() > batch) break;
    tile.at = count, count += tile.count();
    tiles_.push_back(tile);
  }
  if (x_.size() < count) {
    for (std::vector<float>* v : {&x_, &y_, &z_, &f_}) v->resize(count);
    inside_.resize(count + 8);
  }
  return count;
}

// One line along z, then one sheet of lines along y, then all sheets.
void TileScanner::place(const Tile& tile, const FieldGrid& grid) {
  const auto [nx, ny, nz] = tile.points;
  const std::size_t sheet = std::size_t{ny} * nz;
  float *x = &x_[tile.at], *y = &y_[tile.at], *z = &z_[tile.at];
  for (std::size_t j = 0; j < ny; ++j) {
    std::copy_n(&grid.coordinate[2][tile.start[2]], nz, z + j * nz);
    std::fill_n(y + j * nz, nz, grid.coordinate[1][tile.start[1] + j]);
  }
  for (std::size_t i = 0; i < nx; ++i) {
    std::fill_n(x + i * sheet, sheet, grid.coordinate[0][tile.start[0] + i]);
    if (i == 0) continue;
    std::copy_n(y, sheet, y + i * sheet);
    std::copy_n(z, sheet, z + i * sheet);
  }
}

// Marks what is inside; false when all points are outside, or inside and within the bounds.
bool TileScanner::has_border(const Tile& tile, const FieldGrid& grid) {
  const auto [any, all] = mark_inside(&f_[tile.at], &inside_[tile.at], tile.count());
  return any && !(all && grid.within(tile.cube));
}

void TileScanner::scan(const Field& field, const FieldGrid& grid, std::span<const GridCube> cubes,
                       std::vector<Bracket>& brackets, FieldPart& part) {
  for (; !cubes.empty(); cubes = cubes.subspan(tiles_.size())) {
    const std::size_t n = collect(grid, cubes, field.batch_size());
    for (const Tile& tile : tiles_) place(tile, grid);
    field.evaluate({std::span(x_).first(n), std::span(y_).first(n), std::span(z_).first(n)}, std::span(f_).first(n));
    for (const Tile& tile : tiles_) {
      if (!has_border(tile, grid)) continue;
      const std::uint64_t side = tile.cube.side / 8;
      for (std::uint64_t b = 0; b < side * side * side; ++b) {
        std::array<std::uint32_t, 3> start{};
        bool seen = true;
        for (unsigned a = 0; a < 3; ++a) {
          start[a] = tile.cube.corner[a] + morton_decode(b)[a] * 8u;
          seen = seen && start[a] >= tile.start[a] && start[a] < tile.start[a] + tile.points[a];
        }
        if (seen) scan_brick(tile, grid, start, brackets, part);
      }
    }
  }
}

void TileScanner::scan_brick(const Tile& tile, const FieldGrid& grid, const std::array<std::uint32_t, 3>& corner,
                             std::vector<Bracket>& brackets, FieldPart& part) {
  std::array<std::int32_t, 3> start{};
  for (unsigned a = 0; a < 3; ++a) start[a] = static_cast<std::int32_t>(corner[a]);
  unsigned within_k = 0;
  for (int k = 0; k < 9; ++k) within_k |= grid.within(2, start[2] + k) ? 1u << k : 0u;
  const std::size_t stride[3] = {std::size_t{tile.points[1]} * tile.points[2], tile.points[2], 1};
  std::size_t base = tile.at;
  for (unsigned a = 0; a < 3; ++a) base += (corner[a] - tile.start[a]) * stride[a];
  // Inside along z, in the bits of mask[i][j]; points beyond the bounds are outside.
  unsigned mask[9][9];
  bool within_j[9];
  for (int j = 0; j < 9; ++j) within_j[j] = grid.within(1, start[1] + j);
  unsigned any = 0, all = ~0u;
  for (unsigned i = 0; i < 9; ++i) {
    const bool within_i = grid.within(0, start[0] + static_cast<int>(i));
    for (unsigned j = 0; j < 9; ++j) {
      // Bytes beyond the end of a line are another one's; they lie beyond the bounds.
      mask[i][j] = 0;
      if (within_i && within_j[j]) {
        const std::uint8_t* bytes = &inside_[base + i * stride[0] + j * stride[1]];
        mask[i][j] = (pack_bytes(bytes) | static_cast<unsigned>(bytes[8]) << 8) & within_k;
      }
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
