#include "shape/bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "evenmesh/error.h"
#include "evenmesh/solid.h"

namespace evenmesh {
namespace {

constexpr int largest_exponent = 20, smallest_exponent = -20;  ///< half sides of the cubes, as powers of two
constexpr int shell_depth = 5;                                 ///< subdivisions of a shell's 56 cells
constexpr int shrink_depth = 6;                                ///< 64 cells along each side
constexpr double enough = 0.7;                                 ///< shrinking stops when a side keeps more than this

Box octant(const Box& box, int index) {
  const Vec3 middle = box.center();
  Box part = box;
  for (int axis = 0; axis < 3; ++axis) (index >> axis & 1 ? part.lo : part.hi)[axis] = middle[axis];
  return part;
}

/// True when f ≥ 0 is proved on the box; gives up where the solid shows itself, or at the last subdivision.
bool proved_outside(const Field& field, const Box& box, int depth) {
  if (field.evaluate(box).lo >= 0) return true;
  if (depth == 0 || field.evaluate(box.center(), nullptr) < 0) return false;
  for (int i = 0; i < 8; ++i)
    if (!proved_outside(field, octant(box, i), depth - 1)) return false;
  return true;
}

/// Calls visit(cell) for the 56 cells of side `half` between the cubes of half sides `half` and 2·half; stops at false.
template <typename Visit>
bool each_shell_cell(double half, const Visit& visit) {
  for (int c = 0; c < 64; ++c) {
    const std::array<int, 3> index{c & 3, c >> 2 & 3, c >> 4};
    if (std::all_of(index.begin(), index.end(), [](int i) { return i == 1 || i == 2; })) continue;
    const Vec3 lo = half * Vec3{index[0] - 2.0, index[1] - 2.0, index[2] - 2.0};
    if (!visit(Box{lo, lo + half * Vec3{1, 1, 1}})) return false;
  }
  return true;
}

[[noreturn]] void throw_unbounded(const Field& field) {
  int inside = 0, cells = 0;
  each_shell_cell(std::ldexp(1.0, largest_exponent - 1), [&](const Box& cell) {
    ++cells;
    inside += field.evaluate(cell.center(), nullptr) < 0 ? 1 : 0;
    return true;
  });
  std::string message =
      "the solid does not seem to be bounded; give --bounds x0,y0,z0,x1,y1,z1, or \"bounds\" in a scene";
  if (inside == cells)
    message += ", or flip the sign: f < 0 is inside, and f is negative everywhere far from the origin";
  throw UnusableInput(message);
}

/// Half side of a cube that holds the solid.
double half_side_of_cube(const Field& field) {
  for (int exponent = largest_exponent; exponent > smallest_exponent; --exponent) {
    const double half = std::ldexp(1.0, exponent - 1);
    if (each_shell_cell(half, [&](const Box& cell) { return proved_outside(field, cell, shell_depth); })) continue;
    if (exponent == largest_exponent) throw_unbounded(field);
    return 2 * half;
  }
  return std::ldexp(1.0, smallest_exponent);
}

/// Adds the points of a grid with `steps` cells along each side where f < 0.
void add_inside_points(const Field& field, const Box& box, int steps, Box& found) {
  const std::size_t row = static_cast<std::size_t>(steps) + 1;
  std::vector<float> x(row), y(row), z(row), values(row);
  const Vec3 step = box.size() / steps;
  for (std::size_t i = 0; i < row; ++i) x[i] = static_cast<float>(box.lo.x + step.x * static_cast<double>(i));
  for (std::size_t k = 0; k < row; ++k) {
    std::fill(z.begin(), z.end(), static_cast<float>(box.lo.z + step.z * static_cast<double>(k)));
    for (std::size_t j = 0; j < row; ++j) {
      std::fill(y.begin(), y.end(), static_cast<float>(box.lo.y + step.y * static_cast<double>(j)));
      field.evaluate(PointBatch{x, y, z}, values);
      for (std::size_t i = 0; i < row; ++i)
        if (values[i] < 0) found.add({x[i], y[i], z[i]});
    }
  }
}

/// Adds the cells of the last subdivision on which f ≥ 0 is not proved. Cells within `found` cannot add anything.
void add_possible_cells(const Field& field, const Box& box, int depth, Box& found) {
  if (found.contains(box.lo) && found.contains(box.hi)) return;
  if (field.evaluate(box).lo >= 0) return;
  if (depth == 0) {
    found.add(box.lo);
    found.add(box.hi);
    return;
  }
  for (int i = 0; i < 8; ++i) add_possible_cells(field, octant(box, i), depth - 1, found);
}

Box intersection(const Box& a, const Box& b) {
  Box c;
  for (int axis = 0; axis < 3; ++axis)
    c.lo[axis] = std::max(a.lo[axis], b.lo[axis]), c.hi[axis] = std::min(a.hi[axis], b.hi[axis]);
  return c;
}

}  // namespace

Box find_bounds(const Field& field) {
  const double half = half_side_of_cube(field);
  Box box{{-half, -half, -half}, {half, half, half}};
  for (int round = 0; round < 40; ++round) {
    Box found;
    add_inside_points(field, box, 32, found);
    const bool seen = !found.empty();
    add_possible_cells(field, box, shrink_depth, found);
    if (found.empty()) break;
    const Vec3 old_size = box.size(), size = found.size();
    const bool rest = size.x > enough * old_size.x && size.y > enough * old_size.y && size.z > enough * old_size.z;
    const Vec3 cell = (rest ? 1.0 : 0.25) / 64 * old_size;
    box = intersection(Box{found.lo - cell, found.hi + cell}, Box{box.lo - cell, box.hi + cell});
    if (!rest) continue;
    Box inside;
    if (!seen) add_inside_points(field, box, 128, inside);
    if (!seen && inside.empty()) break;
    return box;
  }
  throw UnusableInput(
      "f < 0 nowhere found: the solid is empty, or too small; inside is where the expression is negative");
}

namespace {

Box united(Box box, const Box& other) {
  box.add(other.lo), box.add(other.hi);
  return box;
}

/// What all bounded operands have in common.
Box common_bounds(const std::vector<Shape>& operands) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box box{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  std::string reason;
  for (const Shape& operand : operands) try {
      const Box other = find_bounds(operand);
      for (int a = 0; a < 3; ++a)
        box.lo[a] = std::max(box.lo[a], other.lo[a]), box.hi[a] = std::min(box.hi[a], other.hi[a]);
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
  const Compound* compound = shape.compound();
  if (compound == nullptr) return shape.bounds;
  if (compound->kind == Compound::Kind::intersect) return common_bounds(compound->operands);
  Box box = find_bounds(compound->operands[0]);
  if (compound->kind == Compound::Kind::unite)
    for (const Shape& operand : compound->operands) box = united(box, find_bounds(operand));
  if (compound->kind == Compound::Kind::offset && compound->distance > 0)
    for (int a = 0; a < 3; ++a) box.lo[a] -= compound->distance, box.hi[a] += compound->distance;
  return box;
}

}  // namespace evenmesh
