#include "topology/balls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "grid/blocks.h"
#include "grid/morton.h"

namespace evenmesh {
namespace {

constexpr int side = brick_size + 1;
constexpr std::uint32_t none = 0xffffffffu;

/// Inside or outside for the grid points of one brick and the next layer, and the crossings between them.
class BrickSigns {
 public:
  bool& inside(int i, int j, int k) { return inside_[(k * side + j) * side + i]; }
  std::uint32_t& crossing(int axis, int i, int j, int k) {
    return crossing_[((axis * side + k) * side + j) * side + i];
  }

  /// Signs follow from the crossings alone, up to one bit that any crossing tells.
  void load(const SampleSet& samples, const SampleBlock& block) {
    crossing_.fill(none);
    for (std::uint32_t s = block.begin; s < block.end; ++s) {
      const EdgeCode e = samples.edge[s];
      crossing(static_cast<int>(e.axis()), static_cast<int>(e.i()), static_cast<int>(e.j()), static_cast<int>(e.k())) =
          s;
    }
    inside_.fill(false);
    for (int k = 0; k < brick_points; ++k) {
      if (k > 0) inside(0, 0, k) = inside(0, 0, k - 1) != (crossing(2, 0, 0, k - 1) != none);
      for (int j = 0; j < brick_points; ++j) {
        if (j > 0) inside(0, j, k) = inside(0, j - 1, k) != (crossing(1, 0, j - 1, k) != none);
        for (int i = 1; i < side; ++i) inside(i, j, k) = inside(i - 1, j, k) != (crossing(0, i - 1, j, k) != none);
      }
      for (int i = 0; i < brick_points; ++i)
        inside(i, brick_points, k) = inside(i, brick_points - 1, k) != (crossing(1, i, brick_points - 1, k) != none);
    }
    for (int j = 0; j < brick_points; ++j)
      for (int i = 0; i < brick_points; ++i)
        inside(i, j, brick_points) = inside(i, j, brick_points - 1) != (crossing(2, i, j, brick_points - 1) != none);
    const EdgeCode first = samples.edge[block.begin];
    const bool lower = inside(static_cast<int>(first.i()), static_cast<int>(first.j()), static_cast<int>(first.k()));
    if (lower != first.lower_end_inside())
      for (bool& b : inside_) b = !b;
  }
  void fill(bool value) {
    crossing_.fill(none);
    inside_.fill(value);
  }

  static constexpr int brick_points = brick_size;

 private:
  std::array<bool, side * side * side> inside_{};
  std::array<std::uint32_t, 3 * side * side * side> crossing_{};
};

/// The samples of one brick after the union.
struct NewBlock : SampleColumns {
  std::array<std::uint16_t, 3> brick{};
};

class Union {
 public:
  Union(const SampleSet& samples, std::span<const Ball> balls, ExecutionContext& context)
      : samples_(samples), balls_(balls), context_(context) {
    for (const SampleBlock& b : samples.blocks) keys_.push_back(morton_code(b.brick[0], b.brick[1], b.brick[2]));
  }

  SampleSet result() {
    find_bricks();
    if (!samples_.even()) find_relative_weights();
    std::vector<NewBlock> made(touched_.size());
    parallel_for(context_, touched_.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) made[t] = remake(touched_[t].first, touched_[t].second);
    });
    return merge(made);
  }

 private:
  std::int64_t block_at(std::uint64_t key) const {
    const auto it = std::lower_bound(keys_.begin(), keys_.end(), key);
    return it != keys_.end() && *it == key ? it - keys_.begin() : -1;
  }

  /// Bricks with an edge that a ball can reach, each with its balls.
  void find_bricks() {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> pairs;
    const Grid& g = samples_.grid;
    for (std::uint32_t b = 0; b < balls_.size(); ++b) {
      std::array<std::int64_t, 3> lo{}, hi{};
      for (int a = 0; a < 3; ++a) {
        const auto points = static_cast<std::int64_t>(g.size[static_cast<std::size_t>(a)]);
        const double center = (balls_[b].center[a] - g.origin[a]) / g.spacing,
                     reach = balls_[b].radius / g.spacing + 1.5;
        lo[static_cast<std::size_t>(a)] =
            std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(center - reach))) / 8;
        hi[static_cast<std::size_t>(a)] =
            std::min(points - 1, static_cast<std::int64_t>(std::ceil(center + reach))) / 8;
      }
      for (std::int64_t k = lo[2]; k <= hi[2]; ++k)
        for (std::int64_t j = lo[1]; j <= hi[1]; ++j)
          for (std::int64_t i = lo[0]; i <= hi[0]; ++i)
            pairs.push_back({morton_code(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j),
                                         static_cast<std::uint64_t>(k)),
                             b});
    }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [key, b] : pairs) {
      if (touched_.empty() || touched_.back().first != key) touched_.push_back({key, {}});
      touched_.back().second.push_back(b);
    }
  }

  /// Of what a ball adds: weight over area of the samples in the bricks that it touches.
  void find_relative_weights() {
    std::vector<double> area(balls_.size(), 0), weight(balls_.size(), 0);
    for (const auto& [key, balls] : touched_) {
      const std::int64_t at = block_at(key);
      if (at < 0) continue;
      const SampleBlock& block = samples_.blocks[static_cast<std::size_t>(at)];
      double area_here = 0, weight_here = 0;
      for (std::uint32_t i = block.begin; i < block.end; ++i) {
        area_here += samples_.area[i];
        weight_here += samples_.weight[i];
      }
      for (const std::uint32_t b : balls) {
        area[b] += area_here;
        weight[b] += weight_here;
      }
    }
    relative_weight_.resize(balls_.size());
    for (std::size_t b = 0; b < balls_.size(); ++b)
      relative_weight_[b] = area[b] > 0 ? weight[b] / area[b] : samples_.total_weight / samples_.total_area;
  }

  /// A brick without crossings is inside or outside as a whole: as the last layer of the next brick towards −x that has
  /// some.
  bool inside_of_empty(std::array<std::uint16_t, 3> brick) const {
    while (brick[0] > 0) {
      --brick[0];
      const std::int64_t b = block_at(morton_code(brick[0], brick[1], brick[2]));
      if (b < 0) continue;
      BrickSigns signs;
      signs.load(samples_, samples_.blocks[static_cast<std::size_t>(b)]);
      return signs.inside(brick_size, 0, 0);
    }
    return false;
  }

  bool on_border(int axis, std::int64_t p) const {
    return p <= 0 || p + 1 >= static_cast<std::int64_t>(samples_.grid.size[static_cast<std::size_t>(axis)]);
  }

  NewBlock remake(std::uint64_t key, const std::vector<std::uint32_t>& balls) const {
    NewBlock out;
    out.brick = morton_decode(key);
    const std::int64_t old = block_at(key);
    BrickSigns before;
    if (old >= 0)
      before.load(samples_, samples_.blocks[static_cast<std::size_t>(old)]);
    else
      before.fill(inside_of_empty(out.brick));
    BrickSigns after = before;
    const std::array<int, 3> base{8 * out.brick[0], 8 * out.brick[1], 8 * out.brick[2]};
    for (int k = 0; k < side; ++k)
      for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
          if (on_border(0, base[0] + i) || on_border(1, base[1] + j) || on_border(2, base[2] + k)) continue;
          const Vec3 p = samples_.grid.point(base[0] + i, base[1] + j, base[2] + k);
          for (const std::uint32_t b : balls)
            if (squared_norm(p - balls_[b].center) < balls_[b].radius * balls_[b].radius) after.inside(i, j, k) = true;
        }
    const Vec3 center = samples_.grid.point(base[0] + 4.0, base[1] + 4.0, base[2] + 4.0);
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < BrickSigns::brick_points; ++i)
        for (int j = 0; j < BrickSigns::brick_points; ++j)
          for (int k = 0; k < BrickSigns::brick_points; ++k) {
            const bool lower = after.inside(i, j, k),
                       upper = after.inside(i + (axis == 0), j + (axis == 1), k + (axis == 2));
            if (lower != upper) add(axis, {i, j, k}, lower, base, center, before, balls, out);
          }
    return out;
  }

  /// One crossing: the old one, unless it lies in a ball.
  void add(int axis, std::array<int, 3> at, bool lower_inside, const std::array<int, 3>& base, const Vec3& center,
           BrickSigns& before, const std::vector<std::uint32_t>& balls, NewBlock& out) const {
    const double h = samples_.grid.spacing;
    const std::uint32_t old = before.crossing(axis, at[0], at[1], at[2]);
    const Vec3 low = samples_.grid.point(base[0] + at[0], base[1] + at[1], base[2] + at[2]);
    Vec3 step;
    step[axis] = lower_inside ? h : -h;
    Vec3 from = low;  // the inner end
    if (!lower_inside) from[axis] += h;
    double t = 0;
    Vec3 normal;
    if (old != none) {
      const Vec3 p = center + Vec3{samples_.x[old], samples_.y[old], samples_.z[old]};
      t = std::clamp((p[axis] - from[axis]) / step[axis], 0.0, 1.0);
      normal = unpack_normal(samples_.normal[old]);
    }
    bool moved = false;
    std::uint32_t ball = balls.front();
    for (int attempt = 0; attempt < 4; ++attempt) {  // out of one ball, perhaps into the next
      double farthest = t;
      for (const std::uint32_t b : balls) {
        const Vec3 p = from + t * step - balls_[b].center;
        const double inside = balls_[b].radius * balls_[b].radius - squared_norm(p);
        if (inside <= 0) continue;
        const double along = dot(p, step) / (h * h);
        const double exit = t - along + std::sqrt(along * along + inside / (h * h));
        if (exit <= farthest) continue;
        farthest = exit;
        normal = normalized(from + exit * step - balls_[b].center);
        ball = b;
      }
      if (farthest <= t) break;
      t = farthest;
      moved = true;
    }
    if (t >= 1 || (old == none && !moved)) {  // the border cuts the ball
      t = std::min(t, 0.999);
      normal = step / h;
    }
    const Vec3 p = from + t * step - center;
    const bool keep = old != none && !moved;
    const std::size_t at_end = out.size();
    for_each_column(
        [&](const auto& from_old, auto& column) {
          if (!from_old.empty()) {
            column.emplace_back();
            if (old != none) column.back() = from_old[old];
          }
        },
        samples_, out);
    out.edge[at_end] = EdgeCode(static_cast<unsigned>(axis), static_cast<unsigned>(at[0]), static_cast<unsigned>(at[1]),
                                static_cast<unsigned>(at[2]), lower_inside);
    if (keep) return;
    out.x[at_end] = static_cast<float>(p.x);
    out.y[at_end] = static_cast<float>(p.y);
    out.z[at_end] = static_cast<float>(p.z);
    out.area[at_end] = static_cast<float>(sample_area(normal, axis, h));
    if (!out.even()) out.weight[at_end] = static_cast<float>(sample_area(normal, axis, h) * relative_weight_[ball]);
    out.normal[at_end] = pack_normal(normal);
  }

  /// Samples [begin, end) of a brick, before or after the union.
  struct Source {
    const SampleColumns* samples;
    std::size_t begin, end;
    std::array<std::uint16_t, 3> brick;
  };

  /// In the order of the bricks.
  std::vector<Source> sources(const std::vector<NewBlock>& made) const {
    std::vector<Source> list;
    std::size_t next = 0;
    for (std::size_t b = 0; b <= keys_.size(); ++b) {
      const std::uint64_t key = b < keys_.size() ? keys_[b] : ~std::uint64_t{0};
      bool replaced = false;
      for (; next < touched_.size() && touched_[next].first <= key; ++next) {
        if (made[next].size() > 0) list.push_back({&made[next], 0, made[next].size(), made[next].brick});
        replaced |= touched_[next].first == key;
      }
      if (b == keys_.size() || replaced) continue;
      const SampleBlock& block = samples_.blocks[b];
      list.push_back({&samples_, block.begin, block.end, block.brick});
    }
    return list;
  }

  SampleSet merge(const std::vector<NewBlock>& made) const {
    SampleSet out;
    out.grid = samples_.grid;
    out.disagreements = samples_.disagreements;
    out.unresolved = samples_.unresolved;
    out.cut_by_bounds = samples_.cut_by_bounds;
    const std::vector<Source> list = sources(made);
    std::size_t count = 0;
    for (const Source& from : list) {
      const auto begin = static_cast<std::uint32_t>(count);
      count += from.end - from.begin;
      out.blocks.push_back({begin, static_cast<std::uint32_t>(count), from.brick, {}});
    }
    resize_like(out, samples_, count, context_);
    parallel_for(context_, list.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b)
        copy_samples(*list[b].samples, list[b].begin, list[b].end, out, out.blocks[b].begin);
    });
    mark_axes(out, context_);
    for (const float area : out.area) out.total_area += area;
    for (const float weight : out.weights()) out.total_weight += weight;
    return out;
  }

  const SampleSet& samples_;
  std::span<const Ball> balls_;
  ExecutionContext& context_;
  std::vector<std::uint64_t> keys_;  ///< of the blocks, ascending
  std::vector<std::pair<std::uint64_t, std::vector<std::uint32_t>>> touched_;
  std::vector<double> relative_weight_;  ///< by ball; unused where the samples are even
};

}  // namespace

SampleSet unite_balls(const SampleSet& samples, std::span<const Ball> balls, ExecutionContext& context) {
  return Union(samples, balls, context).result();
}

BallIndex::BallIndex(std::vector<Ball> balls, double largest_radius)
    : largest_(std::accumulate(balls.begin(), balls.end(), largest_radius,
                               [](double largest, const Ball& b) { return std::max(largest, b.radius); })),
      centers_(largest_) {
  for (const Ball& b : balls) add(b);
}

void BallIndex::add(const Ball& ball) {
  centers_.add(ball.center);
  balls_.push_back(ball);
}

Vec3 BallIndex::outside(Vec3 p) const {
  for (int attempt = 0; attempt < 8; ++attempt) {
    double deepest = 0;
    Vec3 out;
    near(p, 0, [&](std::uint32_t b) {
      const Vec3 d = p - balls_[b].center;
      const double length = norm(d), depth = balls_[b].radius - length;
      if (depth > deepest && length > 0) {
        deepest = depth;
        out = balls_[b].center + d * (balls_[b].radius / length);
      }
    });
    if (deepest <= 1e-9 * largest_) return p;
    p = out;
  }
  return p;
}

}  // namespace evenmesh
