#include "shape/bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "evenmesh/error.h"
#include "evenmesh/solid.h"
#include "shape/inside_points.h"
#include "shape/probed_bounds.h"

namespace evenmesh {
namespace {

constexpr int largest_exponent = 20, smallest_exponent = -20;  ///< half sides of the cubes, as powers of two
constexpr int farthest_exponent = 26;                          ///< of survey coordinates
constexpr int shell_depth = 5;                                 ///< subdivisions of a shell's 56 cells
constexpr int shrink_depth = 6;                                ///< 64 cells along each side
constexpr double enough = 0.7;                                 ///< shrinking stops when a side keeps more than this

Box octant(const Box& box, int index) {
  const Vec3 middle = box.center();
  Box part = box;
  for (int axis = 0; axis < 3; ++axis) (index >> axis & 1 ? part.lo : part.hi)[axis] = middle[axis];
  return part;
}

/// A box that may still be cut into eight so many times.
struct Cell {
  Box box;
  int depth = 0;
};

/// Depth first, in order, through the cells on which f ≥ 0 is not proved, except those with skip(box); stops when
/// undecided(cells) is false. One cell after the other or, for fields that want batches, thousands together.
template <typename Skip, typename Undecided>
bool each_undecided(const Field& field, std::vector<Cell> cells, const Skip& skip, const Undecided& undecided) {
  const std::size_t together = prefers_batches(field) ? 4096 : 1;
  std::vector<Cell> some;
  std::vector<Box> boxes;
  std::vector<Interval> ranges;
  std::reverse(cells.begin(), cells.end());
  while (!cells.empty()) {
    some.clear();
    boxes.clear();
    for (; !cells.empty() && some.size() < together; cells.pop_back())
      if (!skip(cells.back().box)) {
        some.push_back(cells.back());
        boxes.push_back(cells.back().box);
      }
    if (some.empty()) continue;
    ranges.resize(boxes.size());
    field.enclose(boxes, ranges);
    std::size_t left = 0;
    for (std::size_t i = 0; i < some.size(); ++i)
      if (!(ranges[i].lo >= 0)) some[left++] = some[i];
    some.resize(left);
    if (!undecided(some)) return false;
    for (auto cell = some.rbegin(); cell != some.rend(); ++cell)
      for (int i = 7; i >= 0 && cell->depth > 0; --i) cells.push_back({octant(cell->box, i), cell->depth - 1});
  }
  return true;
}

/// How many of the cells have their middle inside.
std::size_t middles_inside(const Field& field, const std::vector<Cell>& cells) {
  const auto is_negative = [](auto f) { return f < 0; };
  if (!prefers_batches(field))
    return static_cast<std::size_t>(std::count_if(
        cells.begin(), cells.end(), [&](const Cell& cell) { return field.evaluate(cell.box.center(), nullptr) < 0; }));
  if (cells.empty()) return 0;
  std::vector<float> x, y, z, values(cells.size());
  for (const Cell& cell : cells) {
    const Vec3 p = cell.box.center();
    x.push_back(static_cast<float>(p.x));
    y.push_back(static_cast<float>(p.y));
    z.push_back(static_cast<float>(p.z));
  }
  field.evaluate(PointBatch{x, y, z}, values);
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), is_negative));
}

/// What is known of some cells: f ≥ 0 is proved on them, the solid shows itself in them, or neither.
enum class Seen { outside, solid, unknown };

/// Gives up where the solid shows itself, or at the last subdivision.
Seen seen_in(const Field& field, std::vector<Cell> cells) {
  Seen seen = Seen::outside;
  each_undecided(
      field, std::move(cells), [](const Box&) { return false; },
      [&](const std::vector<Cell>& some) {
        if (std::any_of(some.begin(), some.end(), [](const Cell& cell) { return cell.depth == 0; }))
          seen = Seen::unknown;
        if (middles_inside(field, some) > 0) seen = Seen::solid;
        return seen == Seen::outside;
      });
  return seen;
}

/// The 56 cells of side `half` between the cubes of half sides `half` and 2·half.
std::vector<Cell> cells_of_shell(double half) {
  std::vector<Cell> cells;
  for (int c = 0; c < 64; ++c) {
    const std::array<int, 3> index{c & 3, c >> 2 & 3, c >> 4};
    if (std::all_of(index.begin(), index.end(), [](int i) { return i == 1 || i == 2; })) continue;
    const Vec3 lo = half * Vec3{index[0] - 2.0, index[1] - 2.0, index[2] - 2.0};
    cells.push_back({{lo, lo + half * Vec3{1, 1, 1}}, shell_depth});
  }
  return cells;
}

[[noreturn]] void throw_unbounded(const Field& field) {
  const std::vector<Cell> cells = cells_of_shell(std::ldexp(1.0, largest_exponent - 1));
  std::string message =
      "the solid does not seem to be bounded; give --bounds x0,y0,z0,x1,y1,z1, or \"bounds\" in a scene";
  if (middles_inside(field, cells) == cells.size())
    message += ", or flip the sign: f < 0 is inside, and f is negative everywhere far from the origin";
  throw UnusableInput(message);
}

/// The first cube that has something in its shell, and what; where all shells are proved outside, the last one.
struct FirstShell {
  int exponent;
  Seen seen;
};
FirstShell first_shell(const Field& field, int from, int last) {
  for (int exponent = from; exponent > last; --exponent)
    if (const Seen seen = seen_in(field, cells_of_shell(std::ldexp(1.0, exponent - 1))); seen != Seen::outside)
      return {exponent, seen};
  return {last, Seen::outside};
}

/// Half side of a cube that holds the solid; none where that cannot be proved, though the solid does not show itself
/// far out.
std::optional<double> half_side_of_cube(const Field& field) {
  const FirstShell far = first_shell(field, farthest_exponent, largest_exponent);
  if (far.seen != Seen::outside && far.exponent < farthest_exponent) return std::ldexp(1.0, far.exponent);
  const FirstShell near = first_shell(field, largest_exponent, smallest_exponent);
  const bool undecided = near.exponent == largest_exponent && far.exponent == farthest_exponent;
  if (undecided && near.seen == Seen::solid) throw_unbounded(field);
  if (undecided) return {};
  return std::ldexp(1.0, near.exponent);
}

/// Adds the cells of the last subdivision on which f ≥ 0 is not proved. Cells within `found` cannot add anything.
void add_possible_cells(const Field& field, const Box& box, Box& found) {
  each_undecided(
      field, {{box, shrink_depth}}, [&](const Box& cell) { return found.contains(cell.lo) && found.contains(cell.hi); },
      [&](const std::vector<Cell>& some) {
        for (const Cell& cell : some)
          if (cell.depth == 0) {
            found.add(cell.box.lo);
            found.add(cell.box.hi);
          }
        return true;
      });
}

/// Quotients by what passes through zero, and the like, enclose nothing: points are asked instead.
Box unproved_bounds(const Field& field) {
  try {
    return probed_bounds(field);
  } catch (const UnusableInput&) {
    throw_unbounded(field);
  }
}

}  // namespace

Box find_bounds(const Field& field) {
  if (!knows_intervals(field)) return probed_bounds(field);
  const std::optional<double> half = half_side_of_cube(field);
  if (!half) return unproved_bounds(field);
  Box box{{-*half, -*half, -*half}, {*half, *half, *half}};
  for (int round = 0; round < 40; ++round) {
    Box found = inside_points(field, box, {32, 32, 32}).box;
    const bool seen = !found.empty();
    add_possible_cells(field, box, found);
    if (found.empty()) break;
    const Vec3 old_size = box.size(), size = found.size();
    const bool rest = size.x > enough * old_size.x && size.y > enough * old_size.y && size.z > enough * old_size.z;
    const Vec3 cell = (rest ? 1.0 : 0.25) / 64 * old_size;
    box = common(Box{found.lo - cell, found.hi + cell}, Box{box.lo - cell, box.hi + cell});
    if (!rest) continue;
    if (!seen && inside_points(field, box, {128, 128, 128}).inside == 0) break;
    return box;
  }
  throw UnusableInput(
      "f < 0 nowhere found: the solid is empty, or too small for as far away as it is (then give --bounds "
      "x0,y0,z0,x1,y1,z1); inside is where the expression is negative");
}

namespace {

/// What all bounded operands have in common.
Box common_bounds(const std::vector<Shape>& operands) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box box{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  std::string reason;
  for (const Shape& operand : operands) try {
      box = common(box, find_bounds(operand));
    } catch (const UnusableInput& error) {
      reason = error.what();
    }
  if (!is_finite(box.lo)) throw UnusableInput(reason);
  if (box.empty()) throw UnusableInput("the operands of an intersection lie apart: nothing is left");
  return box;
}

}  // namespace

Box find_bounds(const Shape& shape) {
  if (!shape.bounds.empty()) return shape.bounds;
  if (const Field* field = shape.field()) return find_bounds(*field);
  if (shape.ray_source())
    throw InvalidInput("'" + shape.name + "' does not tell where it is: give --bounds x0,y0,z0,x1,y1,z1");
  const Compound* compound = shape.compound();
  if (compound == nullptr) return shape.bounds;
  if (compound->kind == Compound::Kind::intersect) return common_bounds(compound->operands);
  Box box = find_bounds(compound->operands[0]);
  if (compound->kind == Compound::Kind::unite)
    for (const Shape& operand : compound->operands) box = united(box, find_bounds(operand));
  if (compound->kind == Compound::Kind::offset && compound->distance > 0)
    for (int a = 0; a < 3; ++a) {
      box.lo[a] -= compound->distance;
      box.hi[a] += compound->distance;
    }
  return box;
}

}  // namespace evenmesh
