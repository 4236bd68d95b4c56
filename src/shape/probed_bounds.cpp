#include "shape/probed_bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "evenmesh/error.h"
#include "shape/inside_points.h"

namespace evenmesh {
namespace {

constexpr int smallest = -10, largest = 10;  ///< half sides of cubes that may hold the solid, as powers of two
constexpr int room = 3;                      ///< so many larger cubes must show nothing more
constexpr int cube_cells = 39, shrink_cells = 64, final_cells = 128, face_cells = 512, shell_cells = 140;
constexpr double margin = 1.5;  ///< cells around the last points inside
constexpr double enough = 0.7;  ///< shrinking stops when all sides keep more than this
constexpr int max_shrinks = 40, max_growths = 24;

Box grown(const Box& box, const Vec3& by) {
  return {box.lo - by, box.hi + by};
}
std::array<int, 3> cells(int n) {
  return {n, n, n};
}
Box cube_of(int exponent) {
  const double half = std::ldexp(1.0, exponent);
  return {{-half, -half, -half}, {half, half, half}};
}

struct Seen {
  Box points;  ///< at which f < 0
  Box around;  ///< where there may be more
};

/// What was seen in each of the cubes, from the smallest on.
class Cubes {
 public:
  explicit Cubes(const Field& field) {
    for (int k = smallest; k <= largest + room; ++k)
      seen_.push_back(inside_points(field, cube_of(k), cells(cube_cells)));
  }
  bool nothing() const {
    return std::all_of(seen_.begin(), seen_.end(), [](const InsidePoints& p) { return p.inside == 0; });
  }
  float least() const {
    float least = std::numeric_limits<float>::infinity();
    for (const InsidePoints& p : seen_)
      if (p.numbers > 0) least = std::min(least, p.least);
    return least;
  }
  bool everything() const { return seen_.back().inside == seen_.back().asked; }

  /// The smallest cube that holds all, or else something that has room around it.
  std::optional<Seen> solid() const {
    for (const int larger : {largest + room - smallest, room})
      for (int k = smallest; k <= largest; ++k) {
        const Box seen = seen_up_to(std::min(k + larger, largest + room)), cube = cube_of(k);
        const double cell = cube.longest_side() / cube_cells;
        if (!seen.empty() && cube.contains(seen.lo) && cube.contains(seen.hi))
          return Seen{seen, grown(seen, {cell, cell, cell})};
      }
    return std::nullopt;
  }

 private:
  Box seen_up_to(int last) const {
    Box box;
    for (int k = smallest; k <= last; ++k) box = united(box, seen_[static_cast<std::size_t>(k - smallest)].box);
    return box;
  }

  std::vector<InsidePoints> seen_;
};

[[noreturn]] void throw_nowhere(float least) {
  if (std::isinf(least))
    throw UnusableInput("f is not a finite number anywhere: at none of some million points within ±1024");
  throw UnusableInput(
      fmt::format("f < 0 was nowhere found within ±1024, the least value is {:.2g}: the solid is empty or too small "
                  "(inside is where f is negative); give --bounds x0,y0,z0,x1,y1,z1 if it is not, or --level V, above "
                  "that value, if f is a distance that never gets negative, as those of many fractals",
                  least));
}

[[noreturn]] void throw_unbounded(bool everywhere) {
  std::string message =
      "the surface leaves every box that was tried: it reaches beyond ±1024; give --bounds x0,y0,z0,x1,y1,z1";
  if (everywhere) message += ", or flip the sign: f < 0 is inside, and f is negative everywhere far from the origin";
  throw UnusableInput(message);
}

/// Down to what is seen in the box. Points once seen stay in it, those of things thinner than the grid, too.
void shrink(const Field& field, Seen& seen) {
  const auto look = [&](int n) {
    seen.points = united(seen.points, inside_points(field, seen.around, cells(n)).box);
    return seen.around.size() / n;
  };
  for (int round = 0; round < max_shrinks; ++round) {
    const Vec3 old_size = seen.around.size(), cell = look(shrink_cells);
    seen.around = common(grown(seen.points, cell), grown(seen.around, cell));
    const Vec3 size = seen.around.size();
    if (size.x > enough * old_size.x && size.y > enough * old_size.y && size.z > enough * old_size.z) break;
  }
  const Vec3 cell = look(final_cells);
  seen.around = grown(seen.points, margin * cell);
}

/// Outwards to what is seen around the box and on its faces; false when nothing is.
bool grow(const Field& field, Seen& seen) {
  const Box box = seen.around;
  const Vec3 size = box.size();
  const Box wide = grown(box, 0.25 * size + 0.05 * box.longest_side() * Vec3{1, 1, 1});
  Box points = inside_points(field, wide, cells(shell_cells), box).box;
  if (!points.empty()) seen.around = united(box, grown(points, wide.size() / shell_cells));
  for (int a = 0; a < 3; ++a)
    for (const bool upper : {false, true}) {
      Box face = box;
      (upper ? face.lo : face.hi)[a] = upper ? box.hi[a] : box.lo[a];
      std::array<int, 3> n = cells(face_cells);
      n[static_cast<std::size_t>(a)] = 0;
      const Box found = inside_points(field, face, n).box;
      if (found.empty()) continue;
      points = united(points, found);
      Vec3 beyond = upper ? found.hi : found.lo;
      beyond[a] += (upper ? 0.1 : -0.1) * size[a];
      seen.around.add(beyond);
    }
  seen.points = united(seen.points, points);
  return !points.empty();
}

}  // namespace

bool knows_intervals(const Field& field) {
  std::vector<Box> boxes;
  for (const double size : {1e-3, 1.0, 1e3})
    for (const double away : {0.0, 3.0}) {
      const Vec3 middle = away * size * Vec3{0.5, 0.7, 0.9};
      boxes.push_back(grown({middle, middle}, 0.5 * size * Vec3{1, 1, 1}));
    }
  std::vector<Interval> ranges(boxes.size());
  field.enclose(boxes, ranges);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return std::any_of(ranges.begin(), ranges.end(),
                     [](const Interval& r) { return r.lo > -infinity || r.hi < infinity; });
}

Box probed_bounds(const Field& field) {
  const Cubes cubes(field);
  if (cubes.nothing()) throw_nowhere(cubes.least());
  std::optional<Seen> seen = cubes.solid();
  if (!seen) throw_unbounded(cubes.everything());
  shrink(field, *seen);
  const Box limit = cube_of(largest + room);
  bool fits = true;  // not grown since it was shrunk, or shrunk often enough
  for (int round = 0; round < max_growths; ++round) {
    if (grow(field, *seen)) {
      fits = false;
      if (!limit.contains(seen->around.lo) || !limit.contains(seen->around.hi)) break;
    } else if (fits || round > max_growths / 2) {
      return seen->around;
    } else {
      shrink(field, *seen);
      fits = true;
    }
  }
  throw_unbounded(false);
}

}  // namespace evenmesh
