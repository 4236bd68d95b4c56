// One sign grid out of three opinions, a layer of grid points at a time.

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "grid/tri_dexel.h"
#include "sample/extra_directions.h"

namespace evenmesh {
namespace {

using Word = std::uint64_t;

constexpr std::uint32_t layers_per_task = 64;

// The bits of one layer of grid points, rows along x.
struct Layer {
  std::vector<Word> bits;
  void clear(std::size_t words) { bits.assign(words, 0); }
};

// Who is asked besides the three directions.
struct Voters {
  const std::array<DexelAxis, 3>& raw;
  const ExtraDirections* extra_directions = nullptr;
  double rounding = 0;  // cells
};

// What three directions and their majority say of one layer.
struct AxisOccupancy {
  Layer axis[3], majority;
  std::size_t disputed = 0;  // points, less those settled by rounding
};

// One grid edge whose crossing changes.
struct Edit {
  std::uint32_t p = 0, q = 0;
  std::uint16_t cell = 0;
  bool crosses = false, enters = false;

  auto key() const { return std::tuple(q / brick_size, p, q, cell); }
};

using Edits = std::array<std::vector<Edit>, 3>;

struct Votes {
  Edits edits;
  std::size_t disagreements = 0;
};

// The layers [first, last] of a solid.
class LayerVoter {
 public:
  LayerVoter(const TriDexel& solid, const Voters& voters, std::uint32_t first, std::uint32_t last)
      : solid_(solid),
        voters_(voters),
        nx_(solid.grid.size[0]),
        ny_(solid.grid.size[1]),
        width_((nx_ + 63) / 64),
        first_(first),
        along_z_(last - first + 1) {
    for (Layer& layer : along_z_) layer.clear(width_ * ny_);
    read_z(last);
  }

  // Reads layer k; k goes up by one from call to call.
  void read(std::uint32_t k, AxisOccupancy& o) {
    for (Layer& layer : o.axis) layer.clear(width_ * ny_);
    for (std::uint32_t y = 0; y < ny_; ++y) read_x(solid_.axes[0].ray(y, k), &o.axis[0].bits[y * width_]);
    read_y(k, o.axis[1]);
    o.axis[2].bits.swap(along_z_[k - first_].bits);
    o.majority.clear(width_ * ny_);
    o.disputed = 0;
    for (std::size_t w = 0; w < width_ * ny_; ++w) {
      const Word a = o.axis[0].bits[w], b = o.axis[1].bits[w], c = o.axis[2].bits[w];
      o.majority.bits[w] = (a & b) | (a & c) | (b & c);
      for (Word left = (a ^ b) | (a ^ c); left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        const int own = static_cast<int>((a >> bit & 1) + (b >> bit & 1) + (c >> bit & 1));
        settle(o.majority.bits[w], w, bit, k, own);
        o.disputed += is_rounding(static_cast<std::uint32_t>(64 * (w % width_)) + static_cast<std::uint32_t>(bit),
                                  static_cast<std::uint32_t>(w / width_), k)
                          ? 0
                          : 1;
      }
    }
  }

  // Edits of the edges within a layer.
  void edit_within(std::uint32_t k, const AxisOccupancy& o, Edits& edits) const {
    const auto overruled = [&](std::size_t axis, std::size_t w) { return o.axis[axis].bits[w] ^ o.majority.bits[w]; };
    for (std::uint32_t y = 0; y < ny_; ++y)
      for (std::uint32_t i = 0; i < width_; ++i) {
        const std::size_t w = y * width_ + i;
        const bool more = i + 1 < width_;
        const auto next = [&](Word here, Word after) { return here >> 1 | (more ? after << 63 : 0); };
        const Word old = o.axis[0].bits[w], now = o.majority.bits[w];
        const Word old_next = next(old, more ? o.axis[0].bits[w + 1] : 0);
        const Word now_next = next(now, more ? o.majority.bits[w + 1] : 0);
        for_edits(old, old_next, now, now_next, [&](std::uint32_t bit, bool crosses, bool enters) {
          edits[0].push_back({y, k, static_cast<std::uint16_t>(64 * i + bit), crosses, enters});
        });
        if (y + 1 == ny_ || (overruled(1, w) | overruled(1, w + width_)) == 0) continue;
        for_edits(o.axis[1].bits[w], o.axis[1].bits[w + width_], now, o.majority.bits[w + width_],
                  [&](std::uint32_t bit, bool crosses, bool enters) {
                    edits[1].push_back({64 * i + bit, k, static_cast<std::uint16_t>(y), crosses, enters});
                  });
      }
  }

  // Edits of the edges from layer k up to the next.
  void edit_between(std::uint32_t k, const AxisOccupancy& low, const AxisOccupancy& high, Edits& edits) const {
    for (std::size_t w = 0; w < width_ * ny_; ++w)
      for_edits(low.axis[2].bits[w], high.axis[2].bits[w], low.majority.bits[w], high.majority.bits[w],
                [&](std::uint32_t bit, bool crosses, bool enters) {
                  edits[2].push_back({static_cast<std::uint32_t>(w % width_ * 64) + bit,
                                      static_cast<std::uint32_t>(w / width_), static_cast<std::uint16_t>(k), crosses,
                                      enters});
                });
  }

 private:
  // Edges whose ends' signs were (old, old_next), are to be (now, now_next), and which cross before or after.
  template <typename Use>
  static void for_edits(Word old, Word old_next, Word now, Word now_next, const Use& use) {
    const Word crosses = now ^ now_next, changed = ((old ^ now) | (old_next ^ now_next)) & ((old ^ old_next) | crosses);
    for (Word rest = changed; rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(rest));
      use(bit, (crosses >> bit & 1) != 0, (now_next >> bit & 1) != 0);
    }
  }

  // Sets the points between each entering and the following leaving crossing.
  static void read_x(std::span<const DexelCrossing> ray, Word* row) {
    for (std::size_t c = 0; c + 1 < ray.size(); c += 2)
      for (std::uint32_t x = ray[c].cell + 1u; x <= ray[c + 1].cell;) {
        const std::uint32_t end = std::min<std::uint32_t>(ray[c + 1].cell + 1u, (x / 64 + 1) * 64);
        row[x / 64] |= (~Word{0} >> (64 - (end - x))) << x % 64;
        x = end;
      }
  }

  void read_y(std::uint32_t k, Layer& layer) const {
    for (std::uint32_t x = 0; x < nx_; ++x)
      for (const DexelCrossing& c : solid_.axes[1].ray(x, k))
        layer.bits[(c.cell + 1u) * width_ + x / 64] ^= Word{1} << x % 64;
    for (std::size_t w = width_; w < width_ * ny_; ++w) layer.bits[w] ^= layer.bits[w - width_];
  }

  void read_z(std::uint32_t last) {
    for (std::uint32_t y = 0; y < ny_; ++y)
      for (std::uint32_t x = 0; x < nx_; ++x)
        for (const DexelCrossing& c : solid_.axes[2].ray(x, y)) {
          const std::uint32_t from = std::max(c.cell + 1u, first_);
          if (from <= last) along_z_[from - first_].bits[y * width_ + x / 64] ^= Word{1} << x % 64;
        }
    for (std::size_t k = 1; k < along_z_.size(); ++k)
      for (std::size_t w = 0; w < width_ * ny_; ++w) along_z_[k].bits[w] ^= along_z_[k - 1].bits[w];
  }

  // Asks the witnesses about a point in dispute.
  void settle(Word& word, std::size_t w, int bit, std::uint32_t k, int own) const {
    if (voters_.extra_directions == nullptr) return;  // the majority of the three
    const double x = static_cast<double>(64 * (w % width_)) + bit, y = static_cast<double>(w / width_);
    // The grid's own rays meet the point itself: three votes each.
    const int votes = 3 * own + voters_.extra_directions->inside(solid_.grid.point(x, y, k));
    const bool inside = 2 * votes > 3 * 3 + ExtraDirections::directions;
    word = inside ? word | Word{1} << bit : word & ~(Word{1} << bit);
  }

  // Whether a ray has a crossing so near to the point that rounding may have moved it to the other side.
  bool is_rounding(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    if (!(voters_.rounding > 0)) return false;
    const std::array<std::uint32_t, 3> at{x, y, z};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto p = static_cast<std::size_t>(dexel_p_axis[a]), q = static_cast<std::size_t>(dexel_q_axis[a]);
      for (const DexelCrossing& hit : voters_.raw[a].ray(at[p], at[q]))
        if (std::abs(hit.cell + double(hit.t) - at[a]) <= voters_.rounding) return true;
    }
    return false;
  }

  const TriDexel& solid_;
  const Voters& voters_;
  std::uint32_t nx_, ny_, width_, first_;
  std::vector<Layer> along_z_;
};

Votes count_votes(const TriDexel& solid, const Voters& voters, std::uint32_t first, std::uint32_t end) {
  Votes votes;
  const std::uint32_t top = solid.grid.size[2] - 1, last = std::min(end, top);
  LayerVoter voter(solid, voters, first, last);
  AxisOccupancy low, high;
  voter.read(first, low);
  for (std::uint32_t k = first; k < end; ++k) {
    votes.disagreements += low.disputed;
    voter.edit_within(k, low, votes.edits);
    if (k == top) break;
    voter.read(k + 1, high);
    voter.edit_between(k, low, high, votes.edits);
    std::swap(low, high);
  }
  return votes;
}

// Fills in where new crossings lie.
class Rebuilder {
 public:
  Rebuilder(TriDexel& solid, const Voters& voters) : solid_(solid), raw_(voters.raw), rounding_(voters.rounding) {}

  // Applies the edits of one slab, sorted by ray and cell.
  void apply(std::size_t axis, std::size_t index, std::span<const Edit> edits) {
    DexelSlab& slab = solid_.axes[axis].slabs[index];
    const std::uint32_t first = std::min(slab.rays() ? slab.first : edits.front().p, edits.front().p);
    const auto end = std::max<std::size_t>(slab.first + slab.rays() / brick_size, edits.back().p + 1u);
    DexelSlab built;
    built.first = first;
    std::size_t e = 0;
    for (auto p = first; p < end; ++p)
      for (std::uint32_t row = 0; row < brick_size; ++row) {
        const auto q = static_cast<std::uint32_t>(index * brick_size + row);
        built.begin.push_back(static_cast<std::uint32_t>(built.crossings.size()));
        const auto from = e;
        while (e < edits.size() && edits[e].p == p && edits[e].q == q) ++e;
        merge(axis, solid_.axes[axis].ray(p, q), edits.subspan(from, e - from), built.crossings);
      }
    built.begin.push_back(static_cast<std::uint32_t>(built.crossings.size()));
    slab = std::move(built);
  }

 private:
  void merge(std::size_t axis, std::span<const DexelCrossing> old, std::span<const Edit> edits,
             std::vector<DexelCrossing>& out) const {
    std::size_t i = 0;
    for (const Edit& edit : edits) {
      while (i < old.size() && old[i].cell < edit.cell) out.push_back(old[i++]);
      if (i < old.size() && old[i].cell == edit.cell) ++i;
      if (edit.crosses) out.push_back(new_crossing(axis, edit));
    }
    out.insert(out.end(), old.begin() + static_cast<std::ptrdiff_t>(i), old.end());
  }

  // A hit that was found on the edge, or so near to it that rounding put it there, else its middle.
  DexelCrossing new_crossing(std::size_t axis, const Edit& edit) const {
    for (const DexelCrossing& hit : raw_[axis].ray(edit.p, edit.q))
      if (hit.cell == edit.cell) return {hit.source, hit.t, edit.cell, edit.enters, hit.synthetic};
    for (const DexelCrossing& hit : raw_[axis].ray(edit.p, edit.q)) {
      const double t = hit.cell + double(hit.t) - edit.cell;
      if (rounding_ > 0 && t >= -rounding_ && t <= 1 + rounding_)
        return {hit.source, t < 0.5 ? 0.0f : 0x1.fffffep-1f, edit.cell, edit.enters, hit.synthetic};
    }
    return {nearest_source(axis, edit), 0.5f, edit.cell, edit.enters, true};
  }

  // Triangle of the hit nearest to the edge's inner end along the three rays through it.
  std::uint32_t nearest_source(std::size_t axis, const Edit& edit) const {
    std::array<std::uint32_t, 3> at{};
    at[static_cast<std::size_t>(dexel_p_axis[axis])] = edit.p;
    at[static_cast<std::size_t>(dexel_q_axis[axis])] = edit.q;
    at[axis] = edit.cell + (edit.enters ? 1u : 0u);
    std::uint32_t source = 0, nearest = ~0u;
    for (std::size_t a = 0; a < 3; ++a)
      for (const DexelCrossing& hit :
           raw_[a].ray(at[static_cast<std::size_t>(dexel_p_axis[a])], at[static_cast<std::size_t>(dexel_q_axis[a])])) {
        const std::uint32_t away = hit.cell > at[a] ? hit.cell - at[a] : at[a] - hit.cell;
        if (away < nearest) {
          nearest = away;
          source = hit.source;
        }
      }
    return source;
  }

  TriDexel& solid_;
  const std::array<DexelAxis, 3>& raw_;
  double rounding_;
};

}  // namespace

void vote(TriDexel& solid, const std::array<DexelAxis, 3>& raw, const ExtraDirections* extra_directions,
          const ExecutionContext& context, double rounding) {
  const Voters voters{raw, extra_directions, rounding};
  const std::uint32_t layers = solid.grid.size[2];
  std::vector<Votes> votes((layers + layers_per_task - 1) / layers_per_task);
  parallel_tasks(context, votes.size(), [&](std::size_t i) {
    const auto first = static_cast<std::uint32_t>(i) * layers_per_task;
    votes[i] = count_votes(solid, voters, first, std::min(first + layers_per_task, layers));
  });
  Edits edits;
  for (Votes& v : votes) {
    solid.disagreements += v.disagreements;
    for (std::size_t a = 0; a < 3; ++a) edits[a].insert(edits[a].end(), v.edits[a].begin(), v.edits[a].end());
  }
  parallel_tasks(context, 3, [&](std::size_t axis) {
    std::vector<Edit>& all = edits[axis];
    std::sort(all.begin(), all.end(), [](const Edit& a, const Edit& b) { return a.key() < b.key(); });
    Rebuilder rebuilder(solid, voters);
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
      const std::size_t slab = all[begin].q / brick_size;
      while (end < all.size() && all[end].q / brick_size == slab) ++end;
      rebuilder.apply(axis, slab, std::span(all).subspan(begin, end - begin));
    }
  });
}

}  // namespace evenmesh
