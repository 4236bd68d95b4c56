#pragma once
/// Changes which grid points of a sampled solid are inside, brick by brick.

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// Inside or outside for the grid points of one brick and the next layer, and the crossings between them.
class BrickSigns {
 public:
  static constexpr int points = brick_size;
  static constexpr int side = brick_size + 1;  ///< the first points of the next bricks belong to it
  static constexpr std::uint32_t none = 0xffffffffu;

  bool& inside(int i, int j, int k) { return inside_[index(i, j, k)]; }
  bool inside(int i, int j, int k) const { return inside_[index(i, j, k)]; }
  /// Sample on the grid edge of `axis` that begins at a point; none: it is not crossed.
  std::uint32_t crossing(int axis, int i, int j, int k) const { return crossing_[axis * volume + index(i, j, k)]; }

  /// Signs follow from the crossings alone, up to one bit that any crossing tells.
  void load(const SampleSet& samples, const SampleBlock& block);
  /// A brick without crossings.
  void fill(bool value);

 private:
  static constexpr int volume = side * side * side;
  static std::size_t index(int i, int j, int k) {
    const int at = (k * side + j) * side + i;
    return static_cast<std::size_t>(at);
  }
  std::array<bool, volume> inside_{};
  std::array<std::uint32_t, 3 * volume> crossing_{};
};

/// A grid edge whose ends differ in sign.
struct CrossedEdge {
  int axis = 0;
  std::array<int, 3> at{};  ///< its lower end in the brick
  bool lower_inside = false;
  std::uint32_t old = BrickSigns::none;  ///< the sample that was here
};

/// Where a new sample lies, as far as it is not the old one.
struct NewCrossing {
  double t = 0;  ///< from the inner end of the edge, 0 … 1
  Vec3 normal;   ///< unit, outward
  double relative_weight = 1;
};

/// The samples of one brick after a change, in the order of its edges.
struct NewBlock : SampleColumns {
  std::array<std::uint16_t, 3> brick{};
};

/// What edits of a solid have in common. Keeps references; safe from several threads.
class SolidEditor {
 public:
  using Brick = std::array<std::uint16_t, 3>;
  explicit SolidEditor(const SampleSet& samples);

  const SampleSet& samples() const { return samples_; }
  struct Sums {
    double area = 0, weight = 0;  ///< model units squared
  };
  /// Of a brick's samples.
  Sums sums_of(Brick brick) const;
  /// −1: it has no samples.
  std::int64_t block_at(Brick brick) const;
  /// A brick without crossings is inside or outside as a whole: as the last layer of the next brick towards −x that has
  /// some.
  BrickSigns signs(Brick brick) const;
  /// The outermost grid points must stay outside.
  bool on_border(Brick brick, int i, int j, int k) const;
  Vec3 point(Brick brick, double i, double j, double k) const {
    return samples_.grid.point(8.0 * brick[0] + i, 8.0 * brick[1] + j, 8.0 * brick[2] + k);
  }
  /// The bricks with a point within `reach` of each centre, with the indices of those centres, by Morton code.
  std::vector<std::pair<std::uint64_t, std::vector<std::uint32_t>>> bricks_near(std::span<const Vec3> centers,
                                                                                std::span<const double> reach) const;

  /// Samples for all edges whose ends differ in `after`: the old one, where there is one and place(edge) says so by
  /// returning nothing.
  template <typename Place>
  NewBlock remake(Brick brick, const BrickSigns& before, const BrickSigns& after, const Place& place) const {
    NewBlock out;
    out.brick = brick;
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < BrickSigns::points; ++i)
        for (int j = 0; j < BrickSigns::points; ++j)
          for (int k = 0; k < BrickSigns::points; ++k) {
            const bool lower = after.inside(i, j, k);
            if (lower == after.inside(i + (axis == 0), j + (axis == 1), k + (axis == 2))) continue;
            const CrossedEdge edge{axis, {i, j, k}, lower, before.crossing(axis, i, j, k)};
            add_old(edge, out);
            if (const auto made = place(edge)) set_last(edge, *made, out);
          }
    return out;
  }

  /// The set with these bricks instead of its own. @param made  by Morton code, ascending
  SampleSet replace(std::span<const NewBlock> made, ExecutionContext& context) const;

 private:
  void add_old(const CrossedEdge& edge, NewBlock& out) const;
  void set_last(const CrossedEdge& edge, const NewCrossing& made, NewBlock& out) const;

  const SampleSet& samples_;
  std::vector<std::uint64_t> keys_;  ///< of the blocks, ascending
};

}  // namespace evenmesh
