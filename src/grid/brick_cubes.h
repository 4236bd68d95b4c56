#pragma once
/// Walks the grid cubes that a surface passes through, brick by brick, and hands out their loops of crossings.

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "evenmesh/execution_context.h"
#include "grid/cube_table.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// A brick of grid cubes and the blocks that hold crossings on its cubes' edges: [dx + 2·dy + 4·dz], −1 = none.
struct CubeBrick {
  std::array<std::int32_t, 8> block{};
  std::array<int, 3> at{};  ///< brick coordinates
};

/// All bricks with a crossed cube, in the order of the blocks; a brick without samples of its own comes with the first
/// block that has it as a lower neighbour. Of a part those that reach into what was left out are not among them.
std::vector<CubeBrick> cube_bricks(const SampleSet& samples, const ExecutionContext& context);

/// Finds the loops of one brick's cubes; reusable, one per thread.
class CubeWalker {
 public:
  explicit CubeWalker(const SampleSet& samples) : samples_(samples) {}

  /// Calls visit(const std::uint32_t* loop, const std::uint8_t* edges, int length): sample indices in cyclic order,
  /// counter-clockwise from outside, and the edges of the cube they lie on (see CubeLoops).
  template <typename Visit>
  void walk_edges(const CubeBrick& brick, const Visit& visit) {
    walk_cubes(brick, [&](unsigned corners, int i, int j, int k) {
      for_loops(corners, i, j, k, [&](const std::uint32_t* loop, int first, int length) {
        visit(loop, &loops_[corners].edge[first], length);
      });
    });
  }
  /// Calls visit(const std::uint32_t* loop, int length).
  template <typename Visit>
  void walk(const CubeBrick& brick, const Visit& visit) {
    walk_edges(brick, [&](const std::uint32_t* loop, const std::uint8_t*, int length) { visit(loop, length); });
  }

  /// Calls visit(const std::uint32_t* loop, int length, unsigned links): where bit i is set, samples i and i + 1 of the
  /// loop, or the last and the first, are to be linked here. So each pair of neighbours along the surface comes once,
  /// from one of the two cubes that see it; of a part twice, as the other one may not be walked.
  template <typename Visit>
  void walk_links(const CubeBrick& brick, const Visit& visit) {
    const unsigned from_both = samples_.left_out.empty() ? 0 : ~0u;
    walk_cubes(brick, [&](unsigned corners, int i, int j, int k) {
      const unsigned links = loops_[corners].lower_links | from_both;
      for_loops(corners, i, j, k, [&](const std::uint32_t* loop, int first, int length) {
        visit(loop, length, links >> first & ((1u << length) - 1));
      });
    });
  }

  /// Calls visit(corners, i, j, k) for every crossed cube: bit c of `corners` is set where corner c is inside.
  template <typename Visit>
  void walk_cubes(const CubeBrick& brick, const Visit& visit) {
    load(brick);
    for (int k = first_; k < last_; ++k)
      for (std::uint64_t cubes = crossed_cubes(k); cubes != 0; cubes &= cubes - 1) {
        const int at = std::countr_zero(cubes), i = at & 7, j = at >> 3;
        const auto corners_of = [&](int y, int z) { return inside_[z][y] >> i & 3u; };
        const unsigned corners =
            corners_of(j, k) | corners_of(j + 1, k) << 2 | corners_of(j, k + 1) << 4 | corners_of(j + 1, k + 1) << 6;
        visit(signs_agree_ ? corners : own_sign(corners, i, j, k), i, j, k);
      }
  }

 private:
  static constexpr int side = brick_size + 1;  ///< points
  static constexpr int pitch = 16;             ///< of rows
  using Bits = std::uint16_t;
  using Rows = std::array<std::array<Bits, pitch>, side>;  ///< [k][j], bit i

  static constexpr int at(int axis, int i, int j, int k) { return ((axis * side + k) * side + j) * side + i; }
  /// By corners and position in CubeLoops: where the edge's sample is, counted from at(0, i, j, k); some zeros behind.
  using Places = std::array<std::array<std::uint16_t, 16>, 256>;
  static const Places& places_of_loops();

  template <typename Visit>
  void for_loops(unsigned corners, int i, int j, int k, const Visit& visit) const {
    const CubeLoops& cube = loops_[corners];
    const auto& place = places_[corners];
    const std::uint32_t* sample = &sample_[at(0, i, j, k)];
    std::uint32_t loop[12];
    for (int first = 0, l = 1; l <= cube.count; ++l) {
      const int length = cube.start[l] - first;
      for (int e = 0; e < 4; ++e) loop[e] = sample[place[first + e]];  // most have three or four
      for (int e = 4; e < length; ++e) loop[e] = sample[place[first + e]];
      visit(loop, first, length);
      first = cube.start[l];
    }
  }
  void load(const CubeBrick& brick);
  void load_block(const SampleBlock& block, int d);
  void find_inside_points();
  void check_signs();
  /// Bit 8·j + i: cube i, j, k is crossed.
  std::uint64_t crossed_cubes(int k) const;
  unsigned own_sign(unsigned corners, int i, int j, int k) const;

  const SampleSet& samples_;
  const std::array<CubeLoops, 256>& loops_ = cube_loops();
  const Places& places_ = places_of_loops();
  std::array<std::uint32_t, 3 * side * side * side> sample_{};  ///< by edge; meaningless where none is crossed
  std::array<Rows, 3> crossed_{}, lower_inside_{};              ///< by axis of the edges
  Rows inside_{};                                               ///< points
  struct {
    int i, j, k;
    bool inside;
  } some_{};                  ///< lower end of a crossed edge
  unsigned layers_ = 0;       ///< bit k: of some crossed edge the lower end lies there
  int first_ = 0, last_ = 0;  ///< layers of points that are looked at: there is nothing below and above
  bool signs_agree_ = true;
};

}  // namespace evenmesh
