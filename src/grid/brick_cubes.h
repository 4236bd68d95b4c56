#pragma once
/// Walks the grid cubes that a surface passes through, brick by brick, and hands out their loops of crossings.

#include <array>
#include <cstdint>
#include <vector>

#include "evenmesh/execution_context.h"
#include "grid/cube_table.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// A brick of grid cubes and the blocks that hold crossings on its cubes' edges: [dx + 2·dy + 4·dz], −1 = none.
struct CubeBrick {
  std::array<std::int64_t, 8> block{};
  std::array<int, 3> at{};  ///< brick coordinates
};

/// All bricks with a crossed cube, in the order of the blocks; a brick without samples of its own comes with the first
/// block that has it as a lower neighbour. Of a part those that reach into what was left out are not among them.
std::vector<CubeBrick> cube_bricks(const SampleSet& samples, const ExecutionContext& context);

/// Finds the loops of one brick's cubes; reusable, one per thread.
class CubeWalker {
 public:
  explicit CubeWalker(const SampleSet& samples) : samples_(samples) { clear_all(); }

  /// Calls visit(const std::uint32_t* loop, const std::uint8_t* edges, int length): sample indices in cyclic order,
  /// counter-clockwise from outside, and the edges of the cube they lie on (see CubeLoops).
  template <typename Visit>
  void walk_edges(const CubeBrick& brick, const Visit& visit) {
    const auto& loops = cube_loops();
    walk_cubes(brick, [&](unsigned corners, int i, int j, int k) {
      const CubeLoops& cube = loops[corners];
      std::uint32_t loop[12];
      for (int l = 0; l < cube.count; ++l) {
        int length = 0;
        for (int e = cube.start[l]; e < cube.start[l + 1]; ++e) loop[length++] = sample_on(cube.edge[e], i, j, k);
        visit(static_cast<const std::uint32_t*>(loop), &cube.edge[cube.start[l]], length);
      }
    });
  }
  /// Calls visit(const std::uint32_t* loop, int length).
  template <typename Visit>
  void walk(const CubeBrick& brick, const Visit& visit) {
    walk_edges(brick, [&](const std::uint32_t* loop, const std::uint8_t*, int length) { visit(loop, length); });
  }

  /// Calls visit(corners, i, j, k) for every crossed cube: bit c of `corners` is set where corner c is inside.
  template <typename Visit>
  void walk_cubes(const CubeBrick& brick, const Visit& visit) {
    load(brick);
    for (int k = 0; k < 8; ++k)
      for (unsigned rows = rows_with_crossings(k); rows != 0; rows &= rows - 1) {
        const int j = __builtin_ctz(rows);
        const Row row = this->row(j, k);
        for (unsigned active = row.active; active != 0; active &= active - 1) {
          const int i = __builtin_ctz(active);
          visit(inside_corners(row, i, j, k), i, j, k);
        }
      }
    unload();
  }

 private:
  static constexpr int side = brick_size + 1;
  /// The cubes that share j and k.
  struct Row {
    std::uint64_t low, high;  ///< byte i: crossed edges of cube i, edges 0 to 7 and 8 to 11
    unsigned active;          ///< bit i: cube i has any
  };

  static int at(int axis, int i, int j, int k) { return ((axis * side + k) * side + j) * side + i; }
  /// Bit j: the cubes of row j, k may be crossed.
  unsigned rows_with_crossings(int k) const {
    const unsigned lines = lines_[k] | lines_[k + 1];
    return (lines | lines >> 1) & 0xffu;
  }
  Row row(int j, int k) const;
  unsigned inside_corners(const Row& row, int i, int j, int k) const;
  std::uint32_t sample_on(int edge, int i, int j, int k) const {
    const int axis = edge >> 2, a = edge & 1, b = edge >> 1 & 1;
    return axis == 0   ? sample_[at(0, i, j + a, k + b)]
           : axis == 1 ? sample_[at(1, i + a, j, k + b)]
                       : sample_[at(2, i + a, j + b, k)];
  }
  void clear_all();
  void load(const CubeBrick& brick);
  void unload();

  const SampleSet& samples_;
  std::array<std::uint32_t, 3 * side * side * side> sample_{};
  std::array<std::uint16_t, 3 * side * side> crossed_{};  ///< [axis][k][j], bit i
  std::array<std::uint16_t, side> lines_{};  ///< [k], bit j: there is a crossing on an edge from a point there
};

}  // namespace evenmesh
