#include "grid/brick_cubes.h"

#include <algorithm>

#include "core/parallel.h"
#include "evenmesh/error.h"
#include "grid/morton.h"

namespace evenmesh {
namespace {

/// Blocks by the coordinates of their brick: open addressing in a table that is at most half full.
class BlockTable {
 public:
  explicit BlockTable(const SampleSet& samples) : samples_(samples) {
    std::size_t slots = 16;
    while (slots < 2 * (samples.blocks.size() + samples.left_out.size())) slots *= 2;
    mask_ = slots - 1;
    block_.assign(slots, none);
    for (std::uint32_t b = 0; b < samples.blocks.size() + samples.left_out.size(); ++b) {
      const auto at = brick(b);
      std::size_t slot = first_slot(at[0], at[1], at[2]);
      while (block_[slot] != none) slot = (slot + 1) & mask_;
      block_[slot] = b;
    }
  }
  /// −1: there is none.
  static constexpr std::int64_t left_out = -2;
  std::int64_t find(int x, int y, int z) const {
    if (x < 0 || y < 0 || z < 0) return -1;
    for (std::size_t slot = first_slot(x, y, z); block_[slot] != none; slot = (slot + 1) & mask_) {
      const auto at = brick(block_[slot]);
      if (at[0] == x && at[1] == y && at[2] == z)
        return block_[slot] < samples_.blocks.size() ? block_[slot] : left_out;
    }
    return -1;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  std::array<std::uint16_t, 3> brick(std::uint32_t b) const {
    return b < samples_.blocks.size() ? samples_.blocks[b].brick
                                      : morton_decode(samples_.left_out[b - samples_.blocks.size()]);
  }
  /// Rows of bricks stay together in memory.
  std::size_t first_slot(int x, int y, int z) const {
    const std::uint64_t row = static_cast<std::uint64_t>(y) << 16 | static_cast<std::uint64_t>(z);
    return ((row * 0x9e3779b97f4a7c15ull >> 24) + static_cast<std::uint64_t>(x)) & mask_;
  }

  const SampleSet& samples_;
  std::size_t mask_ = 0;
  std::vector<std::uint32_t> block_;
};

/// The bricks around block b that come with it: its own, and those without samples whose first block it is.
void bricks_of_block(const SampleSet& samples, const BlockTable& table, std::size_t b, std::vector<CubeBrick>& bricks) {
  const auto& at = samples.blocks[b].brick;
  std::array<std::int64_t, 27> around;  // [x + 3·y + 9·z], the block itself in the middle
  for (int i = 0; i < 27; ++i) around[i] = table.find(at[0] - 1 + i % 3, at[1] - 1 + i / 3 % 3, at[2] - 1 + i / 9);
  for (int shift = 0; shift < 8; ++shift) {
    const int sx = shift & 1, sy = shift >> 1 & 1, sz = shift >> 2;
    CubeBrick brick;
    brick.at = {at[0] - sx, at[1] - sy, at[2] - sz};
    if (brick.at[0] < 0 || brick.at[1] < 0 || brick.at[2] < 0) continue;
    std::int64_t first = -1;
    bool complete = true;
    for (int d = 0; d < 8; ++d) {
      const int x = 1 - sx + (d & 1), y = 1 - sy + (d >> 1 & 1), z = 1 - sz + (d >> 2);
      brick.block[d] = around[x + 3 * y + 9 * z];
      complete &= brick.block[d] != BlockTable::left_out;
      if (brick.block[d] >= 0 && (first < 0 || brick.block[d] < first)) first = brick.block[d];
    }
    if (!complete) continue;
    if (shift == 0 || (brick.block[0] < 0 && first == static_cast<std::int64_t>(b))) bricks.push_back(brick);
  }
}

/// Bit 8a + b of a word of 8 × 8 bits becomes bit 8b + a.
std::uint64_t transposed(std::uint64_t x) {
  std::uint64_t swap = (x ^ x >> 7) & 0x00aa00aa00aa00aaull;
  x ^= swap ^ swap << 7;
  swap = (x ^ x >> 14) & 0x0000cccc0000ccccull;
  x ^= swap ^ swap << 14;
  swap = (x ^ x >> 28) & 0x00000000f0f0f0f0ull;
  return x ^ swap ^ swap << 28;
}

}  // namespace

std::vector<CubeBrick> cube_bricks(const SampleSet& samples, const ExecutionContext& context) {
  constexpr std::size_t piece = 1024;
  const BlockTable table(samples);
  std::vector<std::vector<CubeBrick>> of_piece((samples.blocks.size() + piece - 1) / piece);
  parallel_tasks(context, of_piece.size(), [&](std::size_t p) {
    of_piece[p].reserve(piece * 5 / 4);
    for (std::size_t b = p * piece; b < std::min(samples.blocks.size(), (p + 1) * piece); ++b)
      bricks_of_block(samples, table, b, of_piece[p]);
  });
  std::vector<CubeBrick> bricks;
  bricks.reserve(samples.blocks.size() * 5 / 4);
  for (const auto& list : of_piece) bricks.insert(bricks.end(), list.begin(), list.end());
  return bricks;
}

void CubeWalker::clear_all() {
  sample_.fill(0);
  unload();
}

void CubeWalker::load(const CubeBrick& brick) {
  for (int d = 0; d < 8; ++d) {
    if (brick.block[d] < 0) continue;
    const int dx = d & 1, dy = d >> 1 & 1, dz = d >> 2;
    const SampleBlock& block = samples_.blocks[brick.block[d]];
    for (std::uint32_t s = block.begin; s < block.end; ++s) {
      const EdgeCode code = samples_.edge[s];
      const int i = code.i(), j = code.j(), k = code.k(), axis = code.axis();
      // Of a neighbouring brick only the edges that lie in the shared layer.
      if ((dx && (i != 0 || axis == 0)) || (dy && (j != 0 || axis == 1)) || (dz && (k != 0 || axis == 2))) continue;
      const int x = i + 8 * dx, y = j + 8 * dy, z = k + 8 * dz;
      sample_[at(axis, x, y, z)] = s;
      crossed_[(axis * side + z) * side + y] |= static_cast<std::uint16_t>(1u << x);
      lines_[z] |= static_cast<std::uint16_t>(1u << y);
    }
  }
}

void CubeWalker::unload() {
  crossed_.fill(0);
  lines_.fill(0);
}

CubeWalker::Row CubeWalker::row(int j, int k) const {
  const auto bits = [&](int axis, int jj, int kk) { return crossed_[(axis * side + kk) * side + jj]; };
  // By edge first: byte e, bit i; then turned over.
  std::uint64_t low = 0, high = 0;
  unsigned any = 0;
  for (int b = 0; b < 2; ++b)
    for (int a = 0; a < 2; ++a) {
      const unsigned x = bits(0, j + a, k + b) & 0xffu, y = bits(1, j, k + b) >> a & 0xffu,
                     z = bits(2, j + b, k) >> a & 0xffu;
      const int e = 8 * (a + 2 * b);
      low |= std::uint64_t{x} << e | std::uint64_t{y} << (32 + e);
      high |= std::uint64_t{z} << e;
      any |= x | y | z;
    }
  return {transposed(low), transposed(high), any};
}

unsigned CubeWalker::inside_corners(const Row& row, int i, int j, int k) const {
  const unsigned crossed =
      static_cast<unsigned>(row.low >> 8 * i & 0xff) | static_cast<unsigned>(row.high >> 8 * i & 0xff) << 8;
  const unsigned corners = corners_of_crossed_edges()[crossed];
  if (corners == 0) throw Error("internal error: the samples do not bound a solid");
  const int edge = __builtin_ctz(crossed), axis = edge >> 2, a = edge & 1, b = edge >> 1 & 1;
  const int start = axis == 0 ? 2 * a + 4 * b : axis == 1 ? a + 4 * b : a + 2 * b;
  const bool start_inside = samples_.edge[sample_on(edge, i, j, k)].lower_end_inside();
  return (corners >> start & 1u) == (start_inside ? 1u : 0u) ? corners : corners ^ 0xffu;
}

}  // namespace evenmesh
