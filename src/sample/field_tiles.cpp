#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "grid/morton.h"
#include "sample/field_parts.h"

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

// The node that a cube lies in.
std::array<std::uint32_t, 3> node_of(const GridCube& cube) {
  return {cube.corner[0] / node_side, cube.corner[1] / node_side, cube.corner[2] / node_side};
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
    result.face_lo[a] = lo;
    result.face_hi[a] = hi;
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
TileScanner::Tile TileScanner::tile_of(std::span<const GridCube> cubes, const FieldGrid& grid) {
  Tile tile;
  tile.cubes = cubes;
  for (unsigned a = 0; a < 3; ++a) {
    std::int32_t start = std::numeric_limits<std::int32_t>::max(), end = 0;
    for (const GridCube& cube : cubes) {
      const auto corner = static_cast<std::int32_t>(cube.corner[a]);
      const std::int32_t first = corner + std::max(grid.first[a] - 1 - corner, 0) / 8 * 8;
      const std::int32_t last = std::min(corner + static_cast<std::int32_t>(cube.side), grid.last[a] + 1);
      start = std::min(start, first);
      end = std::max(end, std::max(last, first) + 1);
    }
    tile.start[a] = static_cast<std::uint32_t>(start);
    tile.points[a] = static_cast<std::uint32_t>(end - start);
  }
  return tile;
}

// Asks for all points of as many cubes as go into a batch, at least one. Returns how many cubes are done; tiles_ are
// those that may hold a border.
std::size_t TileScanner::evaluate_all(const Field& field, const FieldGrid& grid, std::span<const GridCube> cubes) {
  tiles_.clear();
  std::size_t done = 0, n = 0;
  for (; done < cubes.size(); ++done) {
    Tile tile = tile_of(cubes.subspan(done, 1), grid);
    if (done > 0 && n + tile.count() > field.batch_size()) break;
    tile.at = n;
    n += tile.count();
    tiles_.push_back(tile);
  }
  reserve(n, n);
  for (const Tile& tile : tiles_) place(tile, grid);
  field.evaluate({std::span(x_).first(n), std::span(y_).first(n), std::span(z_).first(n)}, std::span(f_).first(n));
  std::erase_if(tiles_, [&](const Tile& tile) { return !has_border(tile, grid); });
  return done;
}

// The same; cubes of one node make a tile, and points that they share are asked for once.
std::size_t TileScanner::evaluate_shared(const Field& field, const FieldGrid& grid, std::span<const GridCube> cubes) {
  constexpr std::size_t most = std::size_t{1} << 23;  // points of the tiles, asked for or not
  tiles_.clear();
  asked_.clear();
  std::size_t done = 0, n = 0;
  while (done < cubes.size() && asked_.size() < field.batch_size()) {
    const auto node = node_of(cubes[done]);
    std::size_t end = done + 1;
    while (end < cubes.size() && node_of(cubes[end]) == node) ++end;
    Tile tile = tile_of(cubes.subspan(done, end - done), grid);
    if (done > 0 && n + tile.count() > most) break;
    tile.at = n;
    n += tile.count();
    done = end;
    reserve(n, 0);
    place_shared(tile, grid);
    tiles_.push_back(tile);
  }
  const std::size_t count = asked_.size();
  values_.resize(count);
  field.evaluate({std::span(x_).first(count), std::span(y_).first(count), std::span(z_).first(count)}, values_);
  for (std::size_t i = 0; i < count; ++i) {
    f_[asked_[i]] = values_[i];
    inside_[asked_[i]] = values_[i] < 0.0f ? 1 : 0;
  }
  return done;
}

void TileScanner::reserve(std::size_t points, std::size_t asked) {
  if (f_.size() < points) {
    f_.resize(points);
    inside_.resize(points + 8);
  }
  if (x_.size() < asked) {
    x_.resize(asked);
    y_.resize(asked);
    z_.resize(asked);
  }
}

// Marks the points of all cubes, then asks for what is marked.
void TileScanner::place_shared(const Tile& tile, const FieldGrid& grid) {
  std::uint8_t* marks = &inside_[tile.at];
  std::fill_n(marks, tile.count(), std::uint8_t{0});
  for (std::size_t c = 0; c < tile.cubes.size(); ++c) {
    const Tile part = tile_of(tile.cubes.subspan(c, 1), grid);
    for (std::uint32_t i = 0; i < part.points[0]; ++i)
      for (std::uint32_t j = 0; j < part.points[1]; ++j)
        std::fill_n(&inside_[tile.index({part.start[0] + i, part.start[1] + j, part.start[2]})], part.points[2],
                    std::uint8_t{1});
  }
  const auto marked = static_cast<std::size_t>(std::count(marks, marks + tile.count(), std::uint8_t{1}));
  std::size_t next = asked_.size(), at = tile.at;
  reserve(0, next + marked);
  for (std::uint32_t i = 0; i < tile.points[0]; ++i)
    for (std::uint32_t j = 0; j < tile.points[1]; ++j)
      for (std::uint32_t k = 0; k < tile.points[2]; ++k, ++at) {
        if (inside_[at] == 0) continue;
        asked_.push_back(at);
        x_[next] = grid.coordinate[0][tile.start[0] + i];
        y_[next] = grid.coordinate[1][tile.start[1] + j];
        z_[next] = grid.coordinate[2][tile.start[2] + k];
        ++next;
      }
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
  return any && !(all && grid.within(tile.cubes[0]));
}

void TileScanner::scan(const Field& field, const FieldGrid& grid, std::span<const GridCube> cubes,
                       std::vector<Bracket>& brackets, FieldPart& part) {
  while (!cubes.empty()) {
    cubes =
        cubes.subspan(prefers_batches(field) ? evaluate_shared(field, grid, cubes) : evaluate_all(field, grid, cubes));
    for (const Tile& tile : tiles_)
      for (const GridCube& cube : tile.cubes) scan_cube(tile, cube, grid, brackets, part);
  }
}

void TileScanner::scan_cube(const Tile& tile, const GridCube& cube, const FieldGrid& grid,
                            std::vector<Bracket>& brackets, FieldPart& part) {
  const std::uint64_t side = cube.side / 8;
  for (std::uint64_t b = 0; b < side * side * side; ++b) {
    std::array<std::uint32_t, 3> start{};
    bool seen = true;
    for (unsigned a = 0; a < 3; ++a) {
      start[a] = cube.corner[a] + morton_decode(b)[a] * 8u;
      seen = seen && start[a] >= tile.start[a] && start[a] < tile.start[a] + tile.points[a];
    }
    if (seen) scan_brick(tile, grid, start, brackets, part);
  }
}

void TileScanner::scan_brick(const Tile& tile, const FieldGrid& grid, const std::array<std::uint32_t, 3>& corner,
                             std::vector<Bracket>& brackets, FieldPart& part) {
  std::array<std::int32_t, 3> start{};
  for (unsigned a = 0; a < 3; ++a) start[a] = static_cast<std::int32_t>(corner[a]);
  unsigned within_k = 0;
  for (int k = 0; k < 9; ++k) within_k |= grid.within(2, start[2] + k) ? 1u << k : 0u;
  const std::size_t stride[3] = {std::size_t{tile.points[1]} * tile.points[2], tile.points[2], 1};
  const std::size_t base = tile.index(corner);
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
      any |= mask[i][j];
      all &= mask[i][j];
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
          bracket.f_lo = f_[at];
          bracket.f_hi = f_[at + stride[axis]];
          const unsigned index[3] = {i, j, k};
          const std::int32_t lower = start[axis] + static_cast<std::int32_t>(index[axis]);
          if (!grid.within(axis, lower)) {
            bracket.on_bounds = true;
            bracket.t_lo = static_cast<float>(grid.face_lo[axis] - lower);
          } else if (!grid.within(axis, lower + 1)) {
            bracket.on_bounds = true;
            bracket.t_hi = static_cast<float>(grid.face_hi[axis] - lower);
          }
          brackets.push_back(bracket);
        }
      }
  if (brackets.size() == first) return;
  SampleBlock block;
  block.begin = static_cast<std::uint32_t>(first);
  block.end = static_cast<std::uint32_t>(brackets.size());
  for (unsigned a = 0; a < 3; ++a) block.brick[a] = static_cast<std::uint16_t>(start[a] / 8);
  part.blocks.push_back(block);
}

}  // namespace evenmesh
