#include "grid/brick_cubes.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/parallel.h"
#include "evenmesh/error.h"
#include "grid/morton.h"

namespace evenmesh {
namespace {

constexpr std::int32_t none = -1, left_out = -2;

/// 4 × 4 × 4 bricks, whose Morton codes differ in the lowest six bits: their blocks follow each other.
struct Tile {
  static constexpr int side = 4;
  static constexpr unsigned bits = 6;
  std::uint64_t key = 0;              ///< the other bits of the code
  std::uint64_t there = 0, left = 0;  ///< by the lowest bits: whether there is a block, whether it was left out
  std::uint32_t first = 0;            ///< its first block
};

/// Ascending.
std::vector<Tile> tiles_of(const SampleSet& samples) {
  std::vector<Tile> tiles;
  const auto tile_of = [&](std::uint64_t code) -> Tile& {
    if (tiles.empty() || tiles.back().key != code >> Tile::bits) tiles.push_back({.key = code >> Tile::bits});
    return tiles.back();
  };
  const auto bit = [](std::uint64_t code) { return std::uint64_t{1} << (code & ((1u << Tile::bits) - 1)); };
  auto left = samples.left_out.begin();
  const auto leave_out_below = [&](std::uint64_t limit) {
    for (; left != samples.left_out.end() && *left < limit; ++left) tile_of(*left).left |= bit(*left);
  };
  for (std::uint32_t b = 0; b < samples.blocks.size(); ++b) {
    const auto& at = samples.blocks[b].brick;
    const std::uint64_t code = morton_code(at[0], at[1], at[2]);
    leave_out_below(code);
    Tile& tile = tile_of(code);
    if (tile.there == 0) tile.first = b;
    tile.there |= bit(code);
  }
  leave_out_below(std::numeric_limits<std::uint64_t>::max());
  return tiles;
}

/// The blocks of a tile and of the layer of bricks around it.
class Neighbourhood {
 public:
  Neighbourhood(const std::vector<Tile>& tiles, const Tile& middle) {
    block_.fill(none);
    const auto at = morton_decode(middle.key);
    for (int n = 0; n < 27; ++n) {
      const int dx = n % 3 - 1, dy = n / 3 % 3 - 1, dz = n / 9 - 1, x = at[0] + dx, y = at[1] + dy, z = at[2] + dz;
      if (std::min({x, y, z}) < 0) continue;
      const std::uint64_t key =
          morton_code(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(z));
      const auto found =
          std::lower_bound(tiles.begin(), tiles.end(), key, [](const Tile& t, std::uint64_t k) { return t.key < k; });
      if (found != tiles.end() && found->key == key) add(*found, {dx * Tile::side, dy * Tile::side, dz * Tile::side});
    }
  }
  /// @param x, y, z  brick from the tile's first, −1 … 4
  std::int32_t block(int x, int y, int z) const { return block_[index(x, y, z)]; }

 private:
  static constexpr int side = Tile::side + 2;
  static std::size_t index(int x, int y, int z) {
    const int i = x + 1 + side * (y + 1 + side * (z + 1));
    return static_cast<std::size_t>(i);
  }
  void add(const Tile& tile, const std::array<int, 3>& from) {
    auto next = static_cast<std::int32_t>(tile.first);
    for (std::uint64_t rest = tile.there | tile.left; rest != 0; rest &= rest - 1) {
      const int bit = std::countr_zero(rest);
      const std::int32_t found = tile.there >> bit & 1 ? next++ : left_out;
      const auto coordinate = [&](int a) { return from[a] + ((bit >> a & 1) | (bit >> (a + 2) & 2)); };
      const int x = coordinate(0), y = coordinate(1), z = coordinate(2);
      if (std::min({x, y, z}) >= -1 && std::max({x, y, z}) <= Tile::side) block_[index(x, y, z)] = found;
    }
  }
  std::array<std::int32_t, side * side * side> block_;
};

/// The bricks around block b that come with it: its own, and those without samples whose first block it is.
void bricks_of_block(const SampleSet& samples, const Neighbourhood& near, std::int32_t b,
                     std::vector<CubeBrick>& bricks) {
  const auto& at = samples.blocks[static_cast<std::size_t>(b)].brick;
  std::array<std::int32_t, 27> around;  // [x + 3·y + 9·z], the block itself in the middle
  constexpr int inside_tile = Tile::side - 1;
  for (int i = 0; i < 27; ++i)
    around[i] = near.block((at[0] & inside_tile) - 1 + i % 3, (at[1] & inside_tile) - 1 + i / 3 % 3,
                           (at[2] & inside_tile) - 1 + i / 9);
  for (int shift = 0; shift < 8; ++shift) {
    const int first = 13 - (shift & 1) - 3 * (shift >> 1 & 1) - 9 * (shift >> 2);
    if (shift > 0 && around[first] != none) continue;
    CubeBrick brick;
    brick.at = {at[0] - (shift & 1), at[1] - (shift >> 1 & 1), at[2] - (shift >> 2)};
    if (brick.at[0] < 0 || brick.at[1] < 0 || brick.at[2] < 0) continue;
    bool ours = true;
    for (int d = 0; d < 8; ++d) {
      brick.block[d] = around[first + (d & 1) + 3 * (d >> 1 & 1) + 9 * (d >> 2)];
      ours &= brick.block[d] != left_out && (shift == 0 || brick.block[d] < 0 || brick.block[d] >= b);
    }
    if (ours) bricks.push_back(brick);
  }
}

}  // namespace

std::vector<CubeBrick> cube_bricks(const SampleSet& samples, const ExecutionContext& context) {
  constexpr std::size_t piece = 64;
  const std::vector<Tile> tiles = tiles_of(samples);
  std::vector<std::vector<CubeBrick>> of_piece((tiles.size() + piece - 1) / piece);
  parallel_tasks(context, of_piece.size(), [&](std::size_t p) {
    for (std::size_t t = p * piece; t < std::min(tiles.size(), (p + 1) * piece); ++t) {
      const Neighbourhood near(tiles, tiles[t]);
      const int count = std::popcount(tiles[t].there);
      for (int b = 0; b < count; ++b)
        bricks_of_block(samples, near, static_cast<std::int32_t>(tiles[t].first) + b, of_piece[p]);
    }
  });
  std::vector<std::size_t> start(of_piece.size() + 1, 0);
  for (std::size_t p = 0; p < of_piece.size(); ++p) start[p + 1] = start[p] + of_piece[p].size();
  std::vector<CubeBrick> bricks(start.back());
  parallel_tasks(context, of_piece.size(), [&](std::size_t p) {
    std::copy(of_piece[p].begin(), of_piece[p].end(), bricks.begin() + static_cast<std::ptrdiff_t>(start[p]));
  });
  return bricks;
}

const CubeWalker::Places& CubeWalker::places_of_loops() {
  static const auto table = [] {
    Places places{};
    for (unsigned corners = 0; corners < 256; ++corners)
      for (unsigned e = 0; e < 12; ++e) {
        const int edge = cube_loops()[corners].edge[e], axis = edge >> 2, a = edge & 1, b = edge >> 1 & 1;
        const int place = axis == 0 ? at(0, 0, a, b) : axis == 1 ? at(1, a, 0, b) : at(2, a, b, 0);
        places[corners][e] = static_cast<std::uint16_t>(place);
      }
    return places;
  }();
  return table;
}

void CubeWalker::load(const CubeBrick& brick) {
  for (; layers_ != 0; layers_ &= layers_ - 1)
    for (int axis = 0; axis < 3; ++axis) {
      crossed_[axis][std::countr_zero(layers_)].fill(0);
      lower_inside_[axis][std::countr_zero(layers_)].fill(0);
    }
  for (int d = 0; d < 7; ++d)  // of the last no edge is shared
    if (brick.block[d] >= 0) load_block(samples_.blocks[static_cast<std::size_t>(brick.block[d])], d);
  first_ = last_ = 0;
  if (layers_ != 0) find_inside_points();
}

/// The block's edges that belong to the brick, which is the block's own or its neighbour at dx + 2·dy + 4·dz towards
/// lower coordinates: of that only those in the shared layer.
void CubeWalker::load_block(const SampleBlock& block, int d) {
  const int step[3] = {8 * (d & 1), 8 * (d >> 1 & 1), 8 * (d >> 2)};
  const unsigned in_layer = EdgeCode(0, step[0] ? 7 : 0, step[1] ? 7 : 0, step[2] ? 7 : 0, false).bits;
  for (int axis = 0; axis < 3; ++axis) {
    if (step[axis] != 0) continue;
    const std::uint32_t end = block.end_of_axis(axis);
    for (std::uint32_t s = block.begin_of_axis(axis); s < end; ++s) {
      const EdgeCode code = samples_.edge[s];
      if (code.bits & in_layer) {
        if (step[0] != 0 && code.i() != 0) break;  // those that follow neither
        continue;
      }
      const int i = int(code.i()) + step[0], j = int(code.j()) + step[1], k = int(code.k()) + step[2];
      const unsigned inside = code.lower_end_inside() ? 1 : 0;
      sample_[at(axis, i, j, k)] = s;
      crossed_[axis][k][j] |= static_cast<Bits>(1u << i);
      lower_inside_[axis][k][j] |= static_cast<Bits>(inside << i);
      if (layers_ == 0) some_ = {i, j, k, inside != 0};
      layers_ |= 1u << k;
    }
  }
}

/// Signs of the points of the brick's cubes: those of neighbours differ where the edge between them is crossed.
void CubeWalker::find_inside_points() {
  constexpr unsigned all = (1u << side) - 1;
  first_ = std::max(std::countr_zero(layers_) - 1, 0);
  last_ = std::min(static_cast<int>(std::bit_width(layers_)), side - 1);
  auto& inside = inside_;
  unsigned row = crossed_[0][first_][0];
  row ^= row << 1;
  row ^= row << 2;
  row ^= row << 4;
  inside[first_].fill(0);
  inside[first_][0] = static_cast<Bits>(row << 1 & all);
  for (int j = 0; j + 1 < side; ++j) inside[first_][j + 1] = inside[first_][j] ^ crossed_[1][first_][j];
  for (int k = first_; k < last_; ++k)
    for (int j = 0; j < pitch; ++j) inside[k + 1][j] = inside[k][j] ^ crossed_[2][k][j];
  if ((inside[some_.k][some_.j] >> some_.i & 1u) != (some_.inside ? 1u : 0u))
    for (int k = first_; k <= last_; ++k)
      for (int j = 0; j < side; ++j) inside[k][j] ^= all;
  check_signs();
}

/// Against all crossed edges.
void CubeWalker::check_signs() {
  Bits wrong = 0, other_sign = 0;
  for (int k = first_; k <= last_; ++k) {
    const auto &here = inside_[k], &x = crossed_[0][k], &y = crossed_[1][k], &z = crossed_[2][k];
    const auto &lower_x = lower_inside_[0][k], &lower_y = lower_inside_[1][k], &lower_z = lower_inside_[2][k];
    for (int j = 0; j < pitch; ++j) {
      const Bits step = static_cast<Bits>(here[j] >> 1), changes = static_cast<Bits>((here[j] ^ step) & 0xff);
      wrong = static_cast<Bits>(wrong | (changes ^ x[j]));
      const Bits differ_x = static_cast<Bits>((here[j] & x[j]) ^ lower_x[j]),
                 differ_y = static_cast<Bits>((here[j] & y[j]) ^ lower_y[j]),
                 differ_z = static_cast<Bits>((here[j] & z[j]) ^ lower_z[j]);
      other_sign = static_cast<Bits>(other_sign | differ_x | differ_y | differ_z);
    }
    for (int j = 0; j + 1 < side; ++j) wrong = static_cast<Bits>(wrong | (here[j] ^ here[j + 1] ^ y[j]));
  }
  if (wrong != 0) throw Error("internal error: the samples do not bound a solid");
  signs_agree_ = other_sign == 0;
}

std::uint64_t CubeWalker::crossed_cubes(int k) const {
  std::uint64_t cubes = 0;
  for (int j = 0; j < 8; ++j) {
    const unsigned a = inside_[k][j], b = inside_[k][j + 1], c = inside_[k + 1][j], d = inside_[k + 1][j + 1];
    const unsigned any = a | b | c | d, every = a & b & c & d;
    cubes |= std::uint64_t{(any | any >> 1) & ~(every & every >> 1) & 0xffu} << 8 * j;
  }
  return cubes;
}

/// By the crossing on its first edge: surfaces that are no neighbours need not agree on where the solid is.
unsigned CubeWalker::own_sign(unsigned corners, int i, int j, int k) const {
  const int edge = loops_[corners].edge[0], axis = edge >> 2, a = edge & 1, b = edge >> 1 & 1;
  const int start = axis == 0 ? 2 * a + 4 * b : axis == 1 ? a + 4 * b : a + 2 * b;
  const bool start_inside = samples_.edge[sample_[at(0, i, j, k) + places_[corners][0]]].lower_end_inside();
  return (corners >> start & 1u) == (start_inside ? 1u : 0u) ? corners : corners ^ 0xffu;
}

}  // namespace evenmesh
