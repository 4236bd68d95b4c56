#include "connect/brick_cubes.h"

#include <algorithm>

#include "evenmesh/error.h"
#include "sample/morton.h"

namespace evenmesh {
std::vector<CubeBrick> cube_bricks(const SampleSet& samples) {
  std::vector<std::uint64_t> keys(samples.blocks.size());  // ascending, as the blocks are
  for (std::size_t b = 0; b < keys.size(); ++b) {
    const auto& brick = samples.blocks[b].brick;
    keys[b] = morton_code(brick[0], brick[1], brick[2]);
  }
  const auto find = [&](int x, int y, int z) {
    const std::uint64_t key = morton_code(x, y, z);
    const auto it = std::lower_bound(keys.begin(), keys.end(), key);
    return it != keys.end() && *it == key ? it - keys.begin() : std::int64_t{-1};
  };

  // In the order of the blocks; a brick without samples of its own comes with the first block that has it as lower
  // neighbour.
  std::vector<CubeBrick> bricks;
  bricks.reserve(samples.blocks.size() * 5 / 4);
  for (std::size_t b = 0; b < samples.blocks.size(); ++b) {
    const auto& at = samples.blocks[b].brick;
    for (int shift = 0; shift < 8; ++shift) {
      const int x = at[0] - (shift & 1), y = at[1] - (shift >> 1 & 1), z = at[2] - (shift >> 2);
      if (x < 0 || y < 0 || z < 0) continue;
      CubeBrick brick;
      brick.at = {x, y, z};
      for (int d = 0; d < 8; ++d) brick.block[d] = find(x + (d & 1), y + (d >> 1 & 1), z + (d >> 2));
      if (shift == 0) {
        bricks.push_back(brick);
        continue;
      }
      if (brick.block[0] >= 0) continue;
      const std::int64_t first = *std::min_element(brick.block.begin(), brick.block.end(), [](auto p, auto q) {
        return static_cast<std::uint64_t>(p) < static_cast<std::uint64_t>(q);
      });
      if (first == static_cast<std::int64_t>(b)) bricks.push_back(brick);
    }
  }
  return bricks;
}

void CubeWalker::clear_all() {
  sample_.fill(0);
  crossed_.fill(0);
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
    }
  }
}

void CubeWalker::unload() {
  crossed_.fill(0);
}

CubeWalker::Row CubeWalker::row(int j, int k) const {
  const auto bits = [&](int axis, int jj, int kk) { return crossed_[(axis * side + kk) * side + jj]; };
  Row r;
  for (int b = 0; b < 2; ++b)
    for (int a = 0; a < 2; ++a) {
      r.bits[0 + a + 2 * b] = bits(0, j + a, k + b);
      r.bits[4 + a + 2 * b] = static_cast<std::uint16_t>(bits(1, j, k + b) >> a);
      r.bits[8 + a + 2 * b] = static_cast<std::uint16_t>(bits(2, j + b, k) >> a);
    }
  unsigned any = 0;
  for (const std::uint16_t b : r.bits) any |= b;
  r.active = any & 0xff;
  return r;
}

unsigned CubeWalker::inside_corners(const Row& row, int i, int j, int k) const {
  unsigned crossed = 0;
  for (int e = 0; e < 12; ++e) crossed |= (row.bits[e] >> i & 1u) << e;
  const unsigned corners = corners_of_crossed_edges()[crossed];
  if (corners == 0) throw Error("internal error: the samples do not bound a solid");
  const int edge = __builtin_ctz(crossed), axis = edge >> 2, a = edge & 1, b = edge >> 1 & 1;
  const int start = axis == 0 ? 2 * a + 4 * b : axis == 1 ? a + 4 * b : a + 2 * b;
  const bool start_inside = samples_.edge[sample_on(edge, i, j, k)].lower_end_inside();
  return (corners >> start & 1u) == (start_inside ? 1u : 0u) ? corners : corners ^ 0xffu;
}

}  // namespace evenmesh
