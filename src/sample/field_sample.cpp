#include <algorithm>
#include <cmath>
#include <limits>

#include "sample/blocks.h"
#include "sample/field_parts.h"
#include "sample/morton.h"

namespace evenmesh {
namespace {

using Index = std::array<std::uint32_t, 3>;

constexpr unsigned kNode = 64;  // grid points per side of a task

struct Node {
  Index corner;
};

// What interval arithmetic says about a cube of grid points.
enum class Verdict { empty, mixed, unknown };

// Holds all points that are asked for in the cube: roots and probes are rounded.
Box cube(const FieldGrid& grid, const Index& corner, unsigned side) {
  Box box;
  const double slack = 0.01 * grid.grid.spacing;
  for (unsigned a = 0; a < 3; ++a) {
    const auto top = std::min<std::size_t>(corner[a] + side, grid.coordinate[a].size() - 1);
    box.lo[static_cast<int>(a)] = grid.coordinate[a][corner[a]] - slack;
    box.hi[static_cast<int>(a)] = grid.coordinate[a][top] + slack;
  }
  return box;
}

Verdict judge(const Field& field, const FieldGrid& grid, const Index& corner, unsigned side) {
  bool within = true;
  for (unsigned a = 0; a < 3; ++a) {
    const auto lo = static_cast<std::int32_t>(corner[a]), hi = static_cast<std::int32_t>(corner[a] + side);
    if (hi < grid.first[a] || lo > grid.last[a]) return Verdict::empty;
    within = within && lo >= grid.first[a] && hi <= grid.last[a];
  }
  const Interval range = field.evaluate(cube(grid, corner, side));
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(range.lo > -infinity) && !(range.hi < infinity)) return Verdict::unknown;
  // The field itself is rounded to float; what is that close to 0 is better looked at.
  const double largest = std::max(std::abs(range.lo), std::abs(range.hi));
  const double guard = largest < infinity ? 1e-6 * largest : 0.0;
  if (range.lo > guard) return Verdict::empty;
  if (range.hi < -guard && within) return Verdict::empty;
  return Verdict::mixed;
}

// Appends the nodes that may hold surface, in Morton order.
void collect_nodes(const Field& field, const FieldGrid& grid, const Index& corner, unsigned side,
                   std::vector<Node>& nodes) {
  for (unsigned a = 0; a < 3; ++a)
    if (corner[a] >= grid.grid.size[a]) return;
  if (judge(field, grid, corner, side) == Verdict::empty) return;
  if (side == kNode) {
    nodes.push_back({corner});
    return;
  }
  const unsigned half = side / 2;
  for (unsigned c = 0; c < 8; ++c)
    collect_nodes(field, grid,
                  {corner[0] + (c & 1) * half, corner[1] + (c >> 1 & 1) * half, corner[2] + (c >> 2) * half}, half,
                  nodes);
}

struct Worker {
  TileScanner scanner;
  RootFinder roots;
  std::vector<Bracket> brackets;

  void descend(const Field& field, const FieldGrid& grid, const Index& corner, unsigned side, FieldPart& part) {
    for (unsigned a = 0; a < 3; ++a)
      if (corner[a] >= grid.grid.size[a]) return;
    const Verdict verdict = judge(field, grid, corner, side);
    if (verdict == Verdict::empty) return;
    // A field that says nothing of this cube will hardly say more of its parts.
    if (side == brick_size || (side == 32 && verdict == Verdict::unknown)) {
      scanner.scan(field, grid, corner, side, brackets, part);
      return;
    }
    const unsigned half = side / 2;
    for (unsigned c = 0; c < 8; ++c)
      descend(field, grid, {corner[0] + (c & 1) * half, corner[1] + (c >> 1 & 1) * half, corner[2] + (c >> 2) * half},
              half, part);
  }

  void sample(const Field& whole, const FieldGrid& grid, const Node& node, FieldPart& part) {
    brackets.clear();
    const std::shared_ptr<const Field> local = whole.specialized(cube(grid, node.corner, kNode));
    const Field& field = local ? *local : whole;
    const unsigned half = kNode / 2;
    for (unsigned c = 0; c < 8; ++c)
      descend(field, grid,
              {node.corner[0] + (c & 1) * half, node.corner[1] + (c >> 1 & 1) * half, node.corner[2] + (c >> 2) * half},
              half, part);
    roots.find(field, grid, brackets, part);
  }
};

SampleSet join_parts(const Grid& grid, std::vector<FieldPart>& parts, const Run& run) {
  SampleSet set;
  set.grid = grid;
  std::vector<std::size_t> start;
  std::size_t count = 0;
  for (const FieldPart& part : parts) {
    start.push_back(count);
    for (SampleBlock block : part.blocks) {
      block.begin += static_cast<std::uint32_t>(count), block.end += static_cast<std::uint32_t>(count);
      set.blocks.push_back(block);
    }
    count += part.x.size();
    set.cut_by_bounds = set.cut_by_bounds || part.cut_by_bounds;
  }
  resize_samples(set, count, false, run);
  parallel_for(run, parts.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      FieldPart& part = parts[i];
      const auto copy = [at = static_cast<std::ptrdiff_t>(start[i])](const auto& from, auto& to) {
        std::copy(from.begin(), from.end(), to.begin() + at);
      };
      copy(part.x, set.x), copy(part.y, set.y), copy(part.z, set.z), copy(part.area, set.area);
      copy(part.normal, set.normal), copy(part.edge, set.edge);
      part = {};
    }
  });
  return set;
}

}  // namespace

SampleSet sample_field(const Field& field, const Grid& grid, const Box& bounds, const Run& run) {
  const FieldGrid field_grid = make_field_grid(grid, bounds);
  unsigned side = kNode;
  while (side < *std::max_element(grid.size.begin(), grid.size.end())) side *= 2;
  std::vector<Node> nodes;
  collect_nodes(field, field_grid, {0, 0, 0}, side, nodes);
  std::vector<FieldPart> parts(nodes.size());
  parallel_for(run, nodes.size(), 1, [&](std::size_t begin, std::size_t end) {
    Worker worker;
    for (std::size_t i = begin; i < end; ++i) worker.sample(field, field_grid, nodes[i], parts[i]);
  });
  SampleSet set = join_parts(grid, parts, run);
  mark_axes(set, run);
  if (!field.has_gradient()) fit_normals(set, run);
  sum_area(set, run);
  return set;
}

}  // namespace evenmesh
