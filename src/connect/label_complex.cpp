#include "connect/label_complex.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include "connect/dual_polygons.h"
#include "grid/brick_union.h"

namespace evenmesh {
namespace {

using Index = std::uint32_t;
constexpr double tiny_piece = 0.1;    ///< of a mean cell
constexpr double divided_cell = 0.3;  ///< of a mean cell

/// What one pass over all cubes collects.
class Complex {
 public:
  Complex(const SampleSet& samples, std::vector<Index>& labels, std::size_t label_count, ExecutionContext& context)
      : samples_(samples),
        labels_(labels),
        context_(context),
        bricks_(cube_bricks(samples, context)),
        sets_(samples, bricks_, context),
        polygons_(bricks_.size()),
        euler_(label_count) {}

  void link() {
    tbb::enumerable_thread_specific<Tally> tallies([&] { return Tally(samples_, euler_.size()); });
    parallel_for(context_, bricks_.size(), 64, [&](std::size_t begin, std::size_t end) {
      Tally& tally = tallies.local();
      for (std::size_t b = begin; b < end; ++b) link_brick(b, tally);
    });
    for (const Tally& tally : tallies) {
      for (std::size_t l = 0; l < euler_.size(); ++l) euler_[l] += tally.twice_euler[l];
      loops_ += tally.loops;
    }
    sets_.settle(context_);
    collect_roots();
  }

  /// The polygons of these bricks again, after some labels changed.
  void refresh_polygons(const std::vector<char>& brick_dirty) {
    tbb::enumerable_thread_specific<CubeWalker> walkers([&] { return CubeWalker(samples_); });
    parallel_for(context_, bricks_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        if (!brick_dirty[b]) continue;
        polygons_[b].clear();
        walkers.local().walk(bricks_[b], [&](const Index* loop, int n) { add_polygon(loop, n, polygons_[b]); });
      }
    });
  }

  UnionFind& sets() { return sets_.sets(); }
  /// One sample of every connected piece of a label, ascending.
  const std::vector<Index>& roots() const { return roots_; }
  const std::vector<CubeBrick>& bricks() const { return bricks_; }
  const std::vector<std::vector<Index>>& polygons() const { return polygons_; }
  /// Whether some samples have no label.
  bool open() const { return open_; }
  /// Twice the Euler number (with compact support) of the interior of a label's quads; 2 per disk.
  const std::vector<std::int64_t>& twice_euler() const { return euler_; }
  /// χ of the quad surface: corners − links + quads, and there are two links for every quad.
  std::int64_t surface_euler() const { return loops_ - static_cast<std::int64_t>(samples_.size()); }

 private:
  struct Tally {
    CubeWalker walker;
    std::vector<std::int32_t> twice_euler;
    std::int64_t loops = 0;
    BrickUnion::Pairs across;     ///< scratch
    std::vector<Index> polygons;  ///< scratch: of one brick
    Tally(const SampleSet& samples, std::size_t labels) : walker(samples), twice_euler(labels, 0) {}
  };

  void link_brick(std::size_t b, Tally& tally) {
    const std::int64_t own_block = bricks_[b].block[0];
    const Index own_begin = own_block < 0 ? 1 : samples_.blocks[own_block].begin;
    const Index own_end = own_block < 0 ? 0 : samples_.blocks[own_block].end;
    for (Index s = own_begin; s < own_end; ++s)
      if (labels_[s] != no_label) tally.twice_euler[labels_[s]] += 2;
    // Every link is met twice, from the cubes on both sides of the face: it counts −1 each time, and is joined once.
    const auto joiner = sets_.joiner(b, tally.across);
    tally.polygons.clear();
    tally.walker.walk_links(bricks_[b], [&](const Index* loop, int n, unsigned links) {
      ++tally.loops;
      const auto after = [n](int i) { return i + 1 == n ? 0 : i + 1; };
      const Index label = labels_[loop[0]];
      bool uniform = true;
      for (int i = 1; i < n && uniform; ++i) uniform = labels_[loop[i]] == label;
      if (uniform) {
        if (label == no_label) return;
        tally.twice_euler[label] += 2 - n;
      } else {
        for (int i = 0; i < n; ++i) {
          const Index s = labels_[loop[i]], t = labels_[loop[after(i)]];
          if (s == t && s != no_label)
            --tally.twice_euler[s];
          else
            links &= ~(1u << i);
        }
        add_polygon(loop, n, tally.polygons);
      }
      for (; links != 0; links &= links - 1) {
        const int i = std::countr_zero(links);
        joiner.join(loop[i], loop[after(i)]);
      }
    });
    if (!tally.polygons.empty()) polygons_[b] = tally.polygons;  // no larger than it must be
  }

  /// Stores the loop as (count, samples): one sample for each run of equal labels, when there are three runs or more.
  void add_polygon(const Index* loop, int n, std::vector<Index>& polygons) const {
    Index context[12];
    Index runs = 0;
    for (int i = 0; i < n; ++i) {
      if (labels_[loop[i]] == no_label) return;
      if (labels_[loop[i]] != labels_[loop[i == 0 ? n - 1 : i - 1]]) context[runs++] = loop[i];
    }
    if (runs < 3) return;
    polygons.push_back(runs);
    polygons.insert(polygons.end(), context, context + runs);
  }

  void collect_roots() {
    constexpr std::size_t piece = 1 << 16;
    std::vector<std::vector<Index>> of_piece((samples_.size() + piece - 1) / piece);
    std::vector<char> open(of_piece.size(), 0);
    parallel_tasks(context_, of_piece.size(), [&](std::size_t p) {
      for (std::size_t i = p * piece; i < std::min(samples_.size(), (p + 1) * piece); ++i)
        if (labels_[i] == no_label)
          open[p] = 1;
        else if (sets_.sets().is_root(static_cast<Index>(i)))
          of_piece[p].push_back(static_cast<Index>(i));
    });
    for (const auto& list : of_piece) roots_.insert(roots_.end(), list.begin(), list.end());
    open_ = std::find(open.begin(), open.end(), 1) != open.end();
  }

  const SampleSet& samples_;
  std::vector<Index>& labels_;
  ExecutionContext& context_;
  std::vector<CubeBrick> bricks_;
  BrickUnion sets_;
  std::vector<Index> roots_;
  std::vector<std::vector<Index>> polygons_;
  std::vector<std::int64_t> euler_;
  std::int64_t loops_ = 0;
  bool open_ = false;
};

/// The samples, block by block, of labels that have several pieces.
std::vector<std::vector<Index>> samples_of_split_labels(const SampleSet& samples, const std::vector<Index>& labels,
                                                        const std::vector<Index>& piece_count,
                                                        const ExecutionContext& context) {
  std::vector<std::vector<Index>> of_block(samples.blocks.size());
  parallel_for(context, of_block.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (Index i = samples.blocks[b].begin; i < samples.blocks[b].end; ++i)
        if (labels[i] != no_label && piece_count[labels[i]] > 1) of_block[b].push_back(i);
  });
  return of_block;
}

struct Piece {
  Index root = 0, label = 0;
  double area = 0;
  Vec3 moment;
  double from_seed = std::numeric_limits<double>::infinity();  ///< squared, of the nearest sample; fixed labels only
};

/// All pieces of the labels that have several, by label; first the one that keeps it: the largest, or where the seed is
/// fixed, the nearest.
std::vector<Piece> pieces_of_split_labels(const SampleSet& samples, const std::vector<Index>& labels, Complex& complex,
                                          const std::vector<Index>& piece_count,
                                          const std::vector<std::vector<Index>>& split, std::span<const Vec3> fixed) {
  UnionFind& sets = complex.sets();
  std::vector<Piece> pieces;
  std::vector<std::pair<Index, Index>> piece_of_root;  // (root, index into pieces), ascending
  for (const Index root : complex.roots())
    if (piece_count[labels[root]] > 1) {
      piece_of_root.push_back({root, static_cast<Index>(pieces.size())});
      pieces.push_back({root, labels[root], 0, {}});
    }
  if (pieces.empty()) return pieces;
  for (std::size_t b = 0; b < split.size(); ++b) {
    const Vec3 center = samples.block_center(samples.blocks[b]);
    for (const Index i : split[b]) {
      const Index root = sets.find(i);
      Piece& piece =
          pieces[std::lower_bound(piece_of_root.begin(), piece_of_root.end(), std::pair{root, Index{0}})->second];
      const Vec3 place = center + Vec3{samples.x[i], samples.y[i], samples.z[i]};
      piece.area += samples.area[i];
      piece.moment += double(samples.area[i]) * place;
      if (labels[i] < fixed.size()) piece.from_seed = std::min(piece.from_seed, squared_norm(place - fixed[labels[i]]));
    }
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return std::tuple(a.label, a.from_seed, -a.area, a.root) < std::tuple(b.label, b.from_seed, -b.area, b.root);
  });
  return pieces;
}

/// Gives every label's first piece its label, other pieces a new one, tiny pieces that of the neighbour with the
/// longest border.
class Splitter {
 public:
  Splitter(const SampleSet& samples, std::vector<Index>& labels, Complex& complex, LabelComplex& result,
           const ExecutionContext& context)
      : samples_(samples), labels_(labels), complex_(complex), result_(result), context_(context) {}

  /// @param piece_count  by given label
  void split(const std::vector<Index>& piece_count, double mean_cell, std::span<const Vec3> fixed) {
    const std::size_t given_labels = piece_count.size();
    result_.labels = given_labels;
    if (std::none_of(piece_count.begin(), piece_count.end(), [](Index n) { return n > 1; })) return;
    split_ = samples_of_split_labels(samples_, labels_, piece_count, context_);
    pieces_ = pieces_of_split_labels(samples_, labels_, complex_, piece_count, split_, fixed);
    std::vector<std::pair<Index, Index>> label_of_root, tiny;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      const Piece& piece = pieces_[p];
      const bool first = p == 0 || pieces_[p - 1].label != piece.label;
      if (first) continue;
      if (piece.area < tiny_piece * cell_to_compare(p, mean_cell)) {
        tiny.push_back({piece.root, static_cast<Index>(p)});
        continue;
      }
      give_new_label(piece, label_of_root);
    }
    adopt_tiny(tiny, label_of_root);
    relabel(label_of_root);
  }

 private:
  /// Cells that were divided on purpose have small pieces: those count by the cell's own size.
  double cell_to_compare(std::size_t p, double mean_cell) const {
    double own = 0;
    std::size_t first = p;
    while (first > 0 && pieces_[first - 1].label == pieces_[p].label) --first;
    for (; first < pieces_.size() && pieces_[first].label == pieces_[p].label; ++first) own += pieces_[first].area;
    return own < divided_cell * mean_cell ? own : mean_cell;
  }
  void give_new_label(const Piece& piece, std::vector<std::pair<Index, Index>>& label_of_root) {
    const auto label = static_cast<Index>(result_.labels++);
    label_of_root.push_back({piece.root, label});
    result_.pieces.push_back({piece.label, label, piece.area, piece.moment / piece.area});
  }

  /// Counts the links of tiny pieces to other roots and hands each over to the most linked one.
  void adopt_tiny(std::vector<std::pair<Index, Index>>& tiny, std::vector<std::pair<Index, Index>>& label_of_root) {
    if (tiny.empty()) return;
    std::sort(tiny.begin(), tiny.end());
    std::vector<char> block_tiny(samples_.blocks.size(), 0);
    UnionFind& sets = complex_.sets();
    const auto is_tiny = [&](Index root) {
      const auto it = std::lower_bound(tiny.begin(), tiny.end(), std::pair{root, Index{0}});
      return it != tiny.end() && it->first == root;
    };
    for (std::size_t b = 0; b < split_.size(); ++b)
      block_tiny[b] = std::any_of(split_[b].begin(), split_[b].end(), [&](Index i) { return is_tiny(sets.find(i)); });
    std::vector<char> brick_dirty(complex_.bricks().size(), 0);
    std::vector<std::pair<Index, Index>> links;  // (tiny root, other root)
    CubeWalker walker(samples_);
    for (std::size_t b = 0; b < brick_dirty.size(); ++b) {
      for (const std::int64_t block : complex_.bricks()[b].block) brick_dirty[b] |= block >= 0 && block_tiny[block];
      if (!brick_dirty[b]) continue;
      walker.walk(complex_.bricks()[b], [&](const Index* loop, int n) {
        for (int i = 0; i < n; ++i) {
          const Index r = sets.find(loop[i]), s = sets.find(loop[(i + 1) % n]);
          if (r == s || labels_[r] == no_label || labels_[s] == no_label) continue;
          if (is_tiny(r) && !is_tiny(s)) links.push_back({r, s});
          if (is_tiny(s) && !is_tiny(r)) links.push_back({s, r});
        }
      });
    }
    std::sort(links.begin(), links.end());
    std::sort(label_of_root.begin(), label_of_root.end());
    const auto settled = label_of_root;
    const auto label_of = [&](Index root) {
      const auto it = std::lower_bound(settled.begin(), settled.end(), std::pair{root, Index{0}});
      return it != settled.end() && it->first == root ? it->second : labels_[root];
    };
    for (const auto& [root, p] : tiny) {
      const auto first = std::lower_bound(links.begin(), links.end(), std::pair{root, Index{0}});
      std::ptrdiff_t best = 0;
      Index best_root = 0;
      for (auto it = first; it != links.end() && it->first == root;) {
        const auto next = std::upper_bound(it, links.end(), *it);
        if (next - it > best) {
          best = next - it;
          best_root = it->second;
        }
        it = next;
      }
      if (best > 0)
        label_of_root.push_back({root, label_of(best_root)});
      else
        give_new_label(pieces_[p],
                       label_of_root);  // nothing around it: a small component of its own, or among such
    }
    dirty_ = std::move(brick_dirty);
  }

  void relabel(std::vector<std::pair<Index, Index>>& label_of_root) {
    std::sort(label_of_root.begin(), label_of_root.end());
    for (const auto& of_block : split_)
      for (const Index i : of_block) {
        const Index root = complex_.sets().find(i);
        const auto it = std::lower_bound(label_of_root.begin(), label_of_root.end(), std::pair{root, Index{0}});
        if (it != label_of_root.end() && it->first == root) labels_[i] = it->second;
      }
    if (!dirty_.empty()) complex_.refresh_polygons(dirty_);
  }

  const SampleSet& samples_;
  std::vector<Index>& labels_;
  Complex& complex_;
  LabelComplex& result_;
  const ExecutionContext& context_;
  std::vector<std::vector<Index>> split_;  ///< by block: the samples of labels that have several pieces
  std::vector<Piece> pieces_;
  std::vector<char> dirty_;
};

}  // namespace

LabelComplex connect_labels(const SampleSet& samples, std::vector<std::uint32_t>& labels, const Seeds& seeds,
                            ExecutionContext& context) {
  LabelComplex result;
  Complex complex(samples, labels, seeds.size(), context);
  complex.link();
  result.surface_euler = complex.surface_euler();
  std::vector<Index> piece_count(seeds.size(), 0);
  for (const Index root : complex.roots()) ++piece_count[labels[root]];
  Splitter(samples, labels, complex, result, context)
      .split(piece_count, samples.total_area / static_cast<double>(seeds.size()), seeds.fixed_positions());

  std::vector<Vec3> positions = seeds.positions;
  for (const CellComponent& piece : result.pieces) positions.push_back(piece.centroid);
  const DualMesh dual = triangulate_polygons(complex.polygons(), labels, positions, complex.open(), context);
  result.triangles = dual.triangles;
  result.defects = dual.defects;
  for (std::size_t l = 0; l < seeds.size(); ++l)
    if (complex.twice_euler()[l] != 2 * static_cast<std::int64_t>(piece_count[l]))
      result.defects.push_back({static_cast<Index>(l), static_cast<Index>(l)});
  std::sort(result.defects.begin(), result.defects.end());
  result.defects.erase(std::unique(result.defects.begin(), result.defects.end()), result.defects.end());
  return result;
}

}  // namespace evenmesh
