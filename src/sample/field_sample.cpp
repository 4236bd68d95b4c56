#include <algorithm>
#include <cmath>
#include <limits>

#include "grid/blocks.h"
#include "grid/morton.h"
#include "sample/field_parts.h"

namespace evenmesh {
namespace {

constexpr std::size_t max_nodes = 64;  // of a task: the roots of all are sought together

using Cubes = std::vector<GridCube>;

// What interval arithmetic says about a cube of grid points.
enum class Verdict { empty, mixed, unknown };

// VertexConstraints all points that are asked for in the cube: roots and probes are rounded.
Box box_of(const FieldGrid& grid, const GridCube& cube) {
  Box box;
  const double slack = 0.01 * grid.grid.spacing;
  for (unsigned a = 0; a < 3; ++a) {
    const auto top = std::min<std::size_t>(cube.corner[a] + cube.side, grid.coordinate[a].size() - 1);
    box.lo[static_cast<int>(a)] = grid.coordinate[a][cube.corner[a]] - slack;
    box.hi[static_cast<int>(a)] = grid.coordinate[a][top] + slack;
  }
  return box;
}

bool meets_bounds(const FieldGrid& grid, const GridCube& cube) {
  for (unsigned a = 0; a < 3; ++a) {
    const auto lo = static_cast<std::int32_t>(cube.corner[a]),
               hi = static_cast<std::int32_t>(cube.corner[a] + cube.side);
    if (cube.corner[a] >= grid.grid.size[a] || hi < grid.first[a] || lo > grid.last[a]) return false;
  }
  return true;
}

// From the root of the grid to bricks, all cubes of one size together. Keeps the order.
class Descent {
 public:
  Descent(const Field& field, const FieldGrid& grid) : field_(field), grid_(grid), batches_(prefers_batches(field)) {}

  // Leaves out the cubes of this side on which f keeps its sign.
  void sift(Cubes& cubes, unsigned side) {
    std::erase_if(cubes, [&](const GridCube& c) { return c.side == side && !meets_bounds(grid_, c); });
    boxes_.clear();
    for (const GridCube& c : cubes)
      if (c.side == side) boxes_.push_back(box_of(grid_, c));
    ranges_.resize(boxes_.size());
    if (!boxes_.empty()) field_.enclose(boxes_, ranges_);
    std::size_t kept = 0, next = 0;
    for (GridCube& c : cubes) {
      if (c.side == side) {
        const Verdict verdict = judge(ranges_[next++], c);
        if (verdict == Verdict::empty) continue;
        c.unknown = verdict == Verdict::unknown;
      }
      cubes[kept++] = c;
    }
    cubes.resize(kept);
  }

  // Cuts the cubes of this side into eight, except unknown ones of at most `largest` cells: a field that says nothing
  // of a cube will hardly say more of its parts.
  void split(Cubes& cubes, unsigned side, unsigned largest) {
    parts_.clear();
    for (const GridCube& c : cubes) {
      if (c.side != side || (c.unknown && side <= largest)) {
        parts_.push_back(c);
        continue;
      }
      const unsigned half = side / 2;
      for (unsigned p = 0; p < 8; ++p)
        parts_.push_back(
            {{c.corner[0] + (p & 1) * half, c.corner[1] + (p >> 1 & 1) * half, c.corner[2] + (p >> 2) * half}, half});
    }
    cubes.swap(parts_);
  }

 private:
  Verdict judge(const Interval& range, const GridCube& cube) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const bool below = range.lo > -infinity, above = range.hi < infinity;
    if (!below && !above) return Verdict::unknown;
    // The field itself is rounded to float; what is that close to 0 is better looked at.
    const double largest = std::max(std::abs(range.lo), std::abs(range.hi));
    const double guard = largest < infinity ? 1e-6 * largest : 0.0;
    if (range.lo > guard) return Verdict::empty;
    if (range.hi < -guard && grid_.within(cube)) return Verdict::empty;
    // One bound alone may be that of a box around a field which tells nothing.
    return batches_ && !(below && above) ? Verdict::unknown : Verdict::mixed;
  }

  const Field& field_;
  const FieldGrid& grid_;
  bool batches_;
  Cubes parts_;
  std::vector<Box> boxes_;
  std::vector<Interval> ranges_;
};

// The nodes that may hold surface, in Morton order.
Cubes collect_nodes(const Field& field, const FieldGrid& grid) {
  unsigned side = node_side;
  while (side < *std::max_element(grid.grid.size.begin(), grid.grid.size.end())) side *= 2;
  Cubes cubes{{{0, 0, 0}, side}};
  Descent descent(field, grid);
  descent.sift(cubes, side);
  for (; side > node_side; side /= 2) {
    descent.split(cubes, side, 0);
    descent.sift(cubes, side / 2);
  }
  return cubes;
}

// Fields that tell nothing, on a fine grid: only every `stride`-th grid point is asked for at first, and bricks whose
// points differ are looked at. The surface is followed from there.
class Sketch {
 public:
  Sketch(const Field& field, const FieldGrid& grid, unsigned stride) : field_(field), grid_(grid), stride_(stride) {}

  // Replaces unknown cubes by their bricks that show a change of sign. Keeps the order.
  void look(Cubes& cubes) {
    x_.clear();
    y_.clear();
    z_.clear();
    for (const GridCube& c : cubes)
      if (c.unknown) place(c);
    values_.resize(x_.size());
    field_.evaluate({x_, y_, z_}, values_);
    bricks_.clear();
    std::size_t at = 0;
    for (const GridCube& c : cubes) {
      if (!c.unknown) {
        bricks_.push_back(c);
        continue;
      }
      const unsigned n = c.side / stride_ + 1, bricks = c.side / brick_size;
      for (std::uint64_t b = 0; b < std::uint64_t{bricks} * bricks * bricks; ++b) {
        const auto brick = morton_decode(b);
        if (is_mixed(c, brick, at, n))
          bricks_.push_back({{c.corner[0] + brick[0] * brick_size, c.corner[1] + brick[1] * brick_size,
                              c.corner[2] + brick[2] * brick_size},
                             brick_size});
      }
      at += std::size_t{n} * n * n;
    }
    cubes.swap(bricks_);
  }

 private:
  std::uint32_t index(const GridCube& cube, unsigned axis, unsigned step) const {
    return std::min(cube.corner[axis] + step * stride_, static_cast<std::uint32_t>(grid_.coordinate[axis].size() - 1));
  }
  void place(const GridCube& c) {
    const unsigned n = c.side / stride_ + 1;
    for (unsigned i = 0; i < n; ++i)
      for (unsigned j = 0; j < n; ++j)
        for (unsigned k = 0; k < n; ++k) {
          x_.push_back(grid_.coordinate[0][index(c, 0, i)]);
          y_.push_back(grid_.coordinate[1][index(c, 1, j)]);
          z_.push_back(grid_.coordinate[2][index(c, 2, k)]);
        }
  }
  bool is_mixed(const GridCube& c, const std::array<std::uint16_t, 3>& brick, std::size_t at, unsigned n) const {
    const unsigned steps = brick_size / stride_;
    unsigned inside = 0;
    for (unsigned i = 0; i <= steps; ++i)
      for (unsigned j = 0; j <= steps; ++j)
        for (unsigned k = 0; k <= steps; ++k) {
          const std::array<unsigned, 3> p{brick[0] * steps + i, brick[1] * steps + j, brick[2] * steps + k};
          bool within = true;
          for (unsigned a = 0; a < 3; ++a)
            within = within && grid_.within(a, static_cast<std::int32_t>(c.corner[a] + p[a] * stride_));
          inside += within && values_[at + (std::size_t{p[0]} * n + p[1]) * n + p[2]] < 0;
        }
    return inside != 0 && inside != (steps + 1) * (steps + 1) * (steps + 1);
  }

  const Field& field_;
  const FieldGrid& grid_;
  unsigned stride_;
  std::vector<float> x_, y_, z_, values_;
  Cubes bricks_;
};

// 1 below 640 grid points along the longest side; above, so many that 240 or more along it are asked for.
unsigned stride_of(const Field& field, const Grid& grid) {
  constexpr std::uint32_t fine = 640, enough = 240;
  const std::uint32_t longest = *std::max_element(grid.size.begin(), grid.size.end());
  unsigned stride = 1;
  while (prefers_batches(field) && stride < brick_size && longest >= std::max(fine, 2 * stride * enough)) stride *= 2;
  return stride;
}

struct Worker {
  TileScanner scanner;
  RootFinder roots;
  std::vector<Bracket> brackets;
  Cubes cubes;

  void sample(const Field& whole, const FieldGrid& grid, std::span<const GridCube> nodes, unsigned stride,
              FieldPart& part) {
    const bool batches = prefers_batches(whole);
    const auto local = batches ? nullptr : whole.specialized(box_of(grid, nodes[0]));
    const Field& field = local ? *local : whole;
    cubes.assign(nodes.begin(), nodes.end());
    Descent descent(field, grid);
    for (unsigned side = node_side; side > brick_size; side /= 2) {
      // Larger cubes share fewer points with their neighbours, smaller ones stay in the cache.
      descent.split(cubes, side, batches ? node_side : node_side / 2);
      descent.sift(cubes, side / 2);
    }
    if (stride > 1) Sketch(field, grid, stride).look(cubes);
    scan(field, grid, cubes, part);
  }
  void scan(const Field& field, const FieldGrid& grid, std::span<const GridCube> where, FieldPart& part) {
    brackets.clear();
    scanner.scan(field, grid, where, brackets, part);
    roots.find(field, grid, brackets, part);
  }
};

// How many nodes a thread takes at once: one, for which the field is specialized, or so many that calls are few.
std::size_t nodes_per_task(const Field& field, std::size_t nodes) {
  return prefers_batches(field) ? std::clamp<std::size_t>(nodes / 4, 1, max_nodes) : 1;
}

SampleSet join_parts(const Grid& grid, const std::vector<FieldPart>& parts, const ExecutionContext& context) {
  SampleSet set;
  set.grid = grid;
  struct Piece {
    std::uint64_t code;
    std::size_t part;
    SampleBlock block;
  };
  std::vector<Piece> pieces;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const SampleBlock& b : parts[p].blocks)
      pieces.push_back({morton_code(b.brick[0], b.brick[1], b.brick[2]), p, b});
    set.cut_by_bounds = set.cut_by_bounds || parts[p].cut_by_bounds;
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.code < b.code; });
  std::uint32_t count = 0;
  for (const Piece& piece : pieces) {
    SampleBlock block = piece.block;
    block.begin = count;
    count += piece.block.end - piece.block.begin;
    block.end = count;
    set.blocks.push_back(block);
  }
  resize_samples(set, count, false, context);
  parallel_for(context, pieces.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SampleBlock& block = pieces[i].block;
      copy_samples(parts[pieces[i].part], block.begin, block.end, set, set.blocks[i].begin);
    }
  });
  return set;
}

// Where the field's word of what is empty was wrong, the surface is followed; pieces that lie apart stay unseen.
void follow(const Field& field, const FieldGrid& grid, std::vector<FieldPart>& parts, const ExecutionContext& context) {
  constexpr std::size_t most = 4096;  // bricks of a part
  for (std::size_t fresh = 0; fresh < parts.size();) {
    const Cubes torn = surface_continuation(parts, fresh, context);
    fresh = parts.size();
    parts.resize(fresh + (torn.size() + most - 1) / most);
    parallel_for(context, parts.size() - fresh, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Worker worker;
        worker.scan(field, grid, std::span(torn).subspan(i * most, std::min(most, torn.size() - i * most)),
                    parts[fresh + i]);
      }
    });
  }
}

}  // namespace

SampleSet sample_field(const Field& field, const Grid& grid, const Box& bounds, const ExecutionContext& context) {
  const FieldGrid field_grid = make_field_grid(grid, bounds);
  const Cubes nodes = collect_nodes(field, field_grid);
  const unsigned stride = stride_of(field, grid);
  const std::size_t step = nodes_per_task(field, nodes.size());
  std::vector<FieldPart> parts((nodes.size() + step - 1) / step);
  parallel_for(context, parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    Worker worker;
    for (std::size_t i = begin; i < end; ++i)
      worker.sample(field, field_grid, std::span(nodes).subspan(i * step, std::min(step, nodes.size() - i * step)),
                    stride, parts[i]);
  });
  if (stride > 1 || !field.encloses_surely()) follow(field, field_grid, parts, context);
  SampleSet set = join_parts(grid, parts, context);
  mark_axes(set, context);
  if (!field.has_gradient()) fit_normals(set, context);
  sum_area(set, context);
  return set;
}

}  // namespace evenmesh
