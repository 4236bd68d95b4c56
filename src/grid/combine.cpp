#include "grid/combine.h"

#include <cmath>
#include <span>

#include "grid/blocks.h"
#include "grid/inside_runs.h"
#include "grid/morton.h"

namespace evenmesh {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

/// One brick of the result, and the blocks of both operands there.
struct Pair {
  std::uint64_t code = 0;
  std::uint32_t a = none, b = none;
};

std::uint64_t code_of(const SampleBlock& block) {
  return morton_code(block.brick[0], block.brick[1], block.brick[2]);
}

std::vector<Pair> pairs_of(const SampleSet& a, const SampleSet& b) {
  std::vector<Pair> pairs;
  std::uint32_t i = 0, j = 0;
  while (i < a.blocks.size() || j < b.blocks.size()) {
    const std::uint64_t of_a = i < a.blocks.size() ? code_of(a.blocks[i]) : ~std::uint64_t{0};
    const std::uint64_t of_b = j < b.blocks.size() ? code_of(b.blocks[j]) : ~std::uint64_t{0};
    Pair pair{std::min(of_a, of_b), none, none};
    if (of_a == pair.code) pair.a = i++;
    if (of_b == pair.code) pair.b = j++;
    pairs.push_back(pair);
  }
  return pairs;
}

/// A sample of one of the operands, perhaps turned around.
struct Taken {
  std::uint32_t index = 0;
  bool from_b = false;
};

class Combiner {
 public:
  Combiner(const SampleSet& a, const SampleSet& b, Boolean operation, const ExecutionContext& context)
      : a_(a), b_(b), operation_(operation), in_a_(a, context), in_b_(b, context) {}

  /// Appends the samples that a brick of the result keeps, in order.
  /// @param thin  may be null; gets the walls and gaps that are too thin to be sampled
  void take(const Pair& pair, std::vector<Taken>& taken, std::vector<ThinSpot>* thin) const {
    taken.clear();
    std::uint32_t i = pair.a == none ? 0 : a_.blocks[pair.a].begin, j = pair.b == none ? 0 : b_.blocks[pair.b].begin;
    const std::uint32_t end_a = pair.a == none ? 0 : a_.blocks[pair.a].end;
    const std::uint32_t end_b = pair.b == none ? 0 : b_.blocks[pair.b].end;
    const auto brick = morton_decode(pair.code);
    while (i < end_a || j < end_b) {
      const unsigned of_a = i < end_a ? a_.edge[i].bits >> 1 : ~0u, of_b = j < end_b ? b_.edge[j].bits >> 1 : ~0u;
      if (of_a < of_b) {
        if (keeps_a(in(in_b_, brick, a_.edge[i]))) taken.push_back({i, false});
        ++i;
      } else if (of_b < of_a) {
        if (keeps_b(in(in_a_, brick, b_.edge[j]))) taken.push_back({j, true});
        ++j;
      } else {
        if (runs_against(i, j) && thin) add_spot(pair, i, j, *thin);
        if (!runs_against(i, j)) take_one(i, j, taken);
        ++i;
        ++j;
      }
    }
  }
  /// Appends the operands' spots where the result has their surface.
  void take_spots(std::vector<ThinSpot>& thin) const {
    const auto take = [&](const SampleSet& set, const InsideRuns& in_other, bool of_a) {
      for (ThinSpot spot : set.thin) {
        const Vec3 p = (spot.place - set.grid.origin) / set.grid.spacing;
        const auto at = [&](int axis) { return static_cast<std::int32_t>(std::lround(p[axis])); };
        const bool inside = in_other(at(0), at(1), at(2));
        if (!(of_a ? keeps_a(inside) : keeps_b(inside))) continue;
        if (!of_a && turns_b()) spot.gap = !spot.gap;
        thin.push_back(spot);
      }
    };
    take(a_, in_b_, true);
    take(b_, in_a_, false);
  }

  bool turns_b() const { return operation_ == Boolean::subtract; }

 private:
  static bool in(const InsideRuns& runs, const std::array<std::uint16_t, 3>& brick, EdgeCode edge) {
    const auto at = [&](std::size_t axis, unsigned cell) { return std::int32_t(brick[axis] * brick_size + cell); };
    return runs(at(0, edge.i()), at(1, edge.j()), at(2, edge.k()));
  }
  /// Whether a crossing of one operand stays where the whole edge is inside the other, or outside.
  bool keeps_a(bool in_b) const { return operation_ == Boolean::intersect ? in_b : !in_b; }
  bool keeps_b(bool in_a) const { return operation_ == Boolean::unite ? !in_a : in_a; }

  bool leaves_a(std::uint32_t i) const { return a_.edge[i].lower_end_inside(); }
  bool leaves_b(std::uint32_t j) const { return b_.edge[j].lower_end_inside() != turns_b(); }
  /// Of two crossings of one edge: whether one enters and the other leaves; then the edge's ends are alike.
  bool runs_against(std::uint32_t i, std::uint32_t j) const { return leaves_a(i) != leaves_b(j); }

  static float along(const SampleSet& set, std::uint32_t i) {
    const unsigned axis = set.edge[i].axis();
    return axis == 0 ? set.x[i] : axis == 1 ? set.y[i] : set.z[i];
  }

  /// A gap of a union, or a wall of what is common, that lies within the edge.
  void add_spot(const Pair& pair, std::uint32_t i, std::uint32_t j, std::vector<ThinSpot>& thin) const {
    const bool gap = operation_ == Boolean::unite;
    const bool a_first = along(a_, i) < along(b_, j);
    if ((a_first ? leaves_a(i) : leaves_b(j)) != gap) return;
    const auto place = [&](const SampleSet& set, std::uint32_t block, std::uint32_t s) {
      return set.block_center(set.blocks[block]) + Vec3{set.x[s], set.y[s], set.z[s]};
    };
    const Vec3 normal = unpack_normal(b_.normal[j]);
    if (const auto spot =
            thin_spot(place(a_, pair.a, i), place(b_, pair.b, j), unpack_normal(a_.normal[i]),
                      turns_b() ? -normal : normal, static_cast<int>(a_.edge[i].axis()), a_.grid.spacing, gap))
      thin.push_back(*spot);
  }

  /// Of two crossings of one edge that run the same way, the one that decides.
  void take_one(std::uint32_t i, std::uint32_t j, std::vector<Taken>& taken) const {
    const bool leaves_a = this->leaves_a(i);
    const float at_a = along(a_, i), at_b = along(b_, j);
    const bool latest = (operation_ == Boolean::unite) == leaves_a;
    const bool b_decides = latest ? at_b > at_a : at_b < at_a;
    taken.push_back(b_decides ? Taken{j, true} : Taken{i, false});
  }

  const SampleSet &a_, &b_;
  Boolean operation_;
  InsideRuns in_a_, in_b_;
};

void turn_around(SampleSet& set, std::uint32_t sample) {
  set.edge[sample].bits ^= 1;
  set.normal[sample] = opposite(set.normal[sample]);
}

}  // namespace

SampleSet combine(const SampleSet& a, const SampleSet& b, Boolean operation, const ExecutionContext& context) {
  const Combiner combiner(a, b, operation, context);
  const std::vector<Pair> pairs = pairs_of(a, b);
  std::vector<std::uint32_t> count(pairs.size());
  std::vector<std::vector<ThinSpot>> thin(pairs.size());
  parallel_for(context, pairs.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<Taken> taken;
    for (std::size_t p = begin; p < end; ++p) {
      combiner.take(pairs[p], taken, &thin[p]);
      count[p] = static_cast<std::uint32_t>(taken.size());
    }
  });
  SampleSet set;
  set.grid = a.grid;
  set.disagreements = a.disagreements + b.disagreements;
  set.unresolved = a.unresolved + b.unresolved;
  combiner.take_spots(set.thin);
  for (const auto& spots : thin) set.unresolved += 2 * spots.size();
  for (const auto& spots : thin) set.thin.insert(set.thin.end(), spots.begin(), spots.end());
  set.cut_by_bounds = a.cut_by_bounds || b.cut_by_bounds;
  std::vector<std::size_t> pair_of_block;
  std::uint32_t total = 0;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    if (count[p] == 0) continue;
    set.blocks.push_back({total, total + count[p], morton_decode(pairs[p].code), {}});
    pair_of_block.push_back(p);
    total += count[p];
  }
  resize_samples(set, total, false, context);
  parallel_for(context, set.blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<Taken> taken;
    for (std::size_t block = begin; block < end; ++block) {
      combiner.take(pairs[pair_of_block[block]], taken, nullptr);
      std::uint32_t at = set.blocks[block].begin;
      for (const Taken& t : taken) {
        copy_sample(t.from_b ? b : a, t.index, set, at);
        if (t.from_b && combiner.turns_b()) turn_around(set, at);
        ++at;
      }
    }
  });
  mark_axes(set, context);
  sum_area(set, context);
  return set;
}

}  // namespace evenmesh
