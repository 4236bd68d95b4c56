#include "sample/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

#include "geometry/closest_point.h"
#include "geometry/triangle.h"
#include "grid/dual_surface.h"
#include "grid/inside_runs.h"
#include "grid/morton.h"

namespace evenmesh {
namespace {

constexpr double same_way = 0.7;  ///< cosine between gradients that see one smooth piece of surface

/// The nearest point of the surface.
struct Nearest {
  Vec3 point, gradient;
  double distance = 0;  ///< signed, negative inside
};

/// Exact distances by closest-point queries.
class SurfaceDistance {
 public:
  SurfaceDistance(const SampleSet& samples, ExecutionContext& context)
      : grid_(samples.grid), inside_(samples, context) {
    const Mesh mesh = dual_surface(samples, context);
    normal_.resize(mesh.triangles.size());
    for (std::size_t t = 0; t < normal_.size(); ++t) {
      const auto [a, b, c] = corners_of(mesh, t);
      normal_[t] = pack_normal(normalized(area_normal(a, b, c)));
    }
    query_.emplace(mesh, context);
  }
  double spacing() const { return grid_.spacing; }

  Nearest find(const Vec3& p, double limit = std::numeric_limits<double>::infinity()) const {
    const ClosestPoint closest = query_->closest(p, limit);
    const Vec3 way = p - closest.point, n = unpack_normal(normal_[closest.triangle]);
    const double distance = std::sqrt(closest.squared_distance);
    // Near the surface its normal tells the side, farther away the grid does.
    const bool inside = distance < grid_.spacing ? dot(way, n) < 0 : is_inside(p);
    Nearest found{closest.point, n, inside ? -distance : distance};
    if (distance > 1e-6 * grid_.spacing) found.gradient = way / found.distance;
    return found;
  }

  /// Where the distance of p lies: −1 below the level by more than `reach`, 1 above, 0 perhaps near it.
  int side_of(const Vec3& p, double level, double reach) const {
    const double away = std::abs(level);
    if (!query_->reaches(p, away + reach)) return is_inside(p) ? -1 : 1;
    if (away > reach && query_->reaches(p, away - reach)) return level > 0 ? -1 : 1;
    // The other side of the surface: that far beyond it.
    return away > grid_.spacing && is_inside(p) != (level < 0) && away > reach ? (level > 0 ? -1 : 1) : 0;
  }

 private:
  bool is_inside(const Vec3& p) const {
    const Vec3 at = (p - grid_.origin) / grid_.spacing;
    const auto nearest = [](double x) { return static_cast<std::int32_t>(std::lround(std::clamp(x, -1e6, 1e6))); };
    return inside_(nearest(at.x), nearest(at.y), nearest(at.z));
  }

  Grid grid_;
  InsideRuns inside_;
  std::vector<PackedNormal> normal_;  ///< by triangle
  std::optional<SurfaceQuery> query_;
};

/// Exact distances at the corners of an octree's cells around one level, and what they say in between.
///
/// A query far from the surface looks at all triangles of a lens as wide as the way is long. Between corners the
/// distance is smooth: the mean of the interpolated distances and of the interpolated tangent planes is exact to second
/// order. Where the corners see different pieces of surface, cells are split, and the smallest ones ask where they have
/// to.
class DistanceLattice {
 public:
  /// @param step   side of the smallest cells, model units
  /// @param levels  of cells above those
  DistanceLattice(const SurfaceDistance& surface, double level, double step, int levels, const Box& box,
                  ExecutionContext& context)
      : surface_(surface), level_(level), step_(step), origin_(box.lo) {
    int top = levels;
    while (std::ldexp(step, top) < box.longest_side()) ++top;
    top_ = top;
    std::vector<Corner> cells{{0, 0, 0}};
    for (int l = top; l >= 0 && !cells.empty(); --l) {
      std::vector<Leaf> leaves = judge(cells, l, box, context);
      if (l <= levels) look_at_corners(cells, l, leaves, context);
      cells = settle(cells, l, leaves);
    }
  }

  /// The leaf that holds a point; remembers the last, since points come in rows.
  struct Place {
    std::array<std::int64_t, 3> at{-1, -1, -1};  ///< in smallest cells
    int level = -1;                              ///< −1: beyond the box
    std::uint32_t leaf = 0;
  };
  Nearest find(const Vec3& p, Place& place) const {
    const Vec3 at = (p - origin_) / step_;
    if (const auto corner = floor_of(at); corner != place.at) enter(corner, place);
    if (place.level < 0) return beyond(p);
    const Leaf& leaf = leaves_[place.leaf];
    if (leaf.kind == Kind::below || leaf.kind == Kind::above) return far_away(p, leaf.kind == Kind::below);
    return leaf.kind == Kind::smooth ? interpolated(p, at, place, leaf) : nearest_of(p, place, leaf);
  }

 private:
  using Corner = std::array<std::uint32_t, 3>;  ///< lower corner of a cell, in smallest cells
  enum class Kind : char { below, above, smooth, rough, split };
  struct Leaf {
    Kind kind = Kind::split;
    std::array<std::uint32_t, 8> node{};
  };

  static std::array<std::int64_t, 3> floor_of(const Vec3& at) {
    return {static_cast<std::int64_t>(std::floor(at.x)), static_cast<std::int64_t>(std::floor(at.y)),
            static_cast<std::int64_t>(std::floor(at.z))};
  }
  static std::uint64_t key_of(const Corner& c) { return morton_code(c[0], c[1], c[2]); }
  static std::uint64_t key_of(const Corner& c, int level) { return std::uint64_t(level) << 58 | key_of(c); }
  static Corner corner_of(const Corner& c, unsigned k, std::uint32_t side) {
    return {c[0] + (k & 1) * side, c[1] + (k >> 1 & 1) * side, c[2] + (k >> 2) * side};
  }
  Vec3 point(const Corner& c) const { return origin_ + step_ * Vec3{double(c[0]), double(c[1]), double(c[2])}; }

  /// Which cells of one size cannot hold the level; the others are to be split.
  std::vector<Leaf> judge(const std::vector<Corner>& cells, int l, const Box& box,
                          const ExecutionContext& context) const {
    std::vector<Leaf> leaves(cells.size());
    const double side = std::ldexp(step_, l);
    parallel_for(context, cells.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 lo = point(cells[i]);
        if (lo.x > box.hi.x || lo.y > box.hi.y || lo.z > box.hi.z) {
          leaves[i].kind = level_ < 0 ? Kind::above : Kind::below;  // never asked for
          continue;
        }
        const int where = surface_.side_of(lo + 0.5 * side * Vec3{1, 1, 1}, level_, 0.87 * side + 0.2 * step_);
        if (where != 0) leaves[i].kind = where < 0 ? Kind::below : Kind::above;
      }
    });
    return leaves;
  }

  /// Distances at the corners of the cells left; they are smooth, or rough if they cannot be split.
  void look_at_corners(const std::vector<Corner>& cells, int l, std::vector<Leaf>& leaves,
                       const ExecutionContext& context) {
    const std::uint32_t side = 1u << l;
    std::vector<std::uint64_t> keys;
    for (std::size_t i = 0; i < cells.size(); ++i)
      for (unsigned k = 0; leaves[i].kind == Kind::split && k < 8; ++k)
        if (const std::uint64_t key = key_of(corner_of(cells[i], k, side)); !node_of_.contains(key))
          keys.push_back(key);
    parallel_sort(context, keys);
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    const auto first = static_cast<std::uint32_t>(node_.size());
    node_.resize(first + keys.size());
    for (std::uint32_t n = 0; n < keys.size(); ++n) node_of_.emplace(keys[n], first + n);
    parallel_for(context, keys.size(), 64, [&](std::size_t begin, std::size_t end) {
      Vec3 last;
      double bound = std::abs(level_) + 3 * std::ldexp(step_, l);
      for (std::size_t n = begin; n < end; ++n) {
        const auto at = morton_decode(keys[n]);
        const Vec3 p = point({at[0], at[1], at[2]});
        Nearest& node = node_[first + n];
        node = surface_.find(p, n == begin ? bound : bound + norm(p - last) * (1 + 1e-6) + 1e-9 * step_);
        bound = std::abs(node.distance);
        last = p;
      }
    });
    parallel_for(context, cells.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (leaves[i].kind != Kind::split) continue;
        for (unsigned k = 0; k < 8; ++k) leaves[i].node[k] = node_of_.at(key_of(corner_of(cells[i], k, side)));
        if (sees_one_piece(leaves[i]))
          leaves[i].kind = Kind::smooth;
        else if (l == 0)
          leaves[i].kind = Kind::rough;
      }
    });
  }
  bool sees_one_piece(const Leaf& leaf) const {
    return std::all_of(leaf.node.begin(), leaf.node.end(), [&](std::uint32_t n) {
      return dot(node_[n].gradient, node_[leaf.node[0]].gradient) > same_way;
    });
  }

  /// Keeps the leaves, and returns the parts of the others.
  std::vector<Corner> settle(const std::vector<Corner>& cells, int l, const std::vector<Leaf>& leaves) {
    std::vector<Corner> parts;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (leaves[i].kind == Kind::split) {
        for (unsigned k = 0; k < 8; ++k) parts.push_back(corner_of(cells[i], k, 1u << (l - 1)));
        continue;
      }
      leaf_of_.emplace(key_of(cells[i], l), static_cast<std::uint32_t>(leaves_.size()));
      leaves_.push_back(leaves[i]);
    }
    return parts;
  }

  void enter(const std::array<std::int64_t, 3>& at, Place& place) const {
    const bool same_leaf = place.level >= 0 && at[0] >= 0 && at[1] >= 0 && at[2] >= 0 &&
                           at[0] >> place.level == place.at[0] >> place.level &&
                           at[1] >> place.level == place.at[1] >> place.level &&
                           at[2] >> place.level == place.at[2] >> place.level;
    place.at = at;
    if (same_leaf) return;
    place.level = -1;
    for (const std::int64_t c : at)
      if (c < 0 || c >> top_ != 0) return;
    for (int l = 0; l <= top_; ++l) {
      const auto found = leaf_of_.find(key_of(cell_at(at, l), l));
      if (found == leaf_of_.end()) continue;
      place.level = l;
      place.leaf = found->second;
      return;
    }
  }
  static Corner cell_at(const std::array<std::int64_t, 3>& at, int l) {
    return {std::uint32_t(at[0]) >> l << l, std::uint32_t(at[1]) >> l << l, std::uint32_t(at[2]) >> l << l};
  }

  Nearest beyond(const Vec3& p) const { return far_away(p, surface_.side_of(p, level_, 0) < 0); }
  /// So far from the level that only its side matters.
  Nearest far_away(const Vec3& p, bool below) const {
    return {p, {1, 0, 0}, level_ + (below ? -8 : 8) * surface_.spacing()};
  }

  Nearest interpolated(const Vec3& p, const Vec3& at, const Place& place, const Leaf& leaf) const {
    const Corner cell = cell_at(place.at, place.level);
    const double side = std::ldexp(1.0, place.level);
    const double share[3] = {(at.x - cell[0]) / side, (at.y - cell[1]) / side, (at.z - cell[2]) / side};
    Vec3 gradient;
    double by_value = 0, by_plane = 0;
    for (unsigned k = 0; k < 8; ++k) {
      double weight = 1;
      for (unsigned a = 0; a < 3; ++a) weight *= (k >> a & 1) != 0 ? share[a] : 1 - share[a];
      const Nearest& node = node_[leaf.node[k]];
      by_value += weight * node.distance;
      by_plane += weight * (node.distance + dot(node.gradient, p - point(corner_of(cell, k, 1u << place.level))));
      gradient += weight * node.gradient;
    }
    return {p, normalized(gradient), 0.5 * (by_value + by_plane)};
  }

  /// Exactly near the level; the corners' nearest points bound the search. Elsewhere only the side is sure.
  Nearest nearest_of(const Vec3& p, const Place& place, const Leaf& leaf) const {
    const Corner cell = cell_at(place.at, place.level);
    double bound = std::numeric_limits<double>::infinity(), lo = -bound, hi = bound;
    for (unsigned k = 0; k < 8; ++k) {
      const Nearest& node = node_[leaf.node[k]];
      const double away = norm(p - point(corner_of(cell, k, 1u << place.level)));
      lo = std::max(lo, node.distance - away);
      hi = std::min(hi, node.distance + away);
      bound = std::min(bound, squared_norm(p - node.point));
    }
    const double margin = 0.01 * step_;
    if (lo > level_ + margin) return {p, {1, 0, 0}, lo};
    if (hi < level_ - margin) return {p, {1, 0, 0}, hi};
    return surface_.find(p, std::sqrt(bound) * (1 + 1e-6) + 1e-9 * step_);
  }

  const SurfaceDistance& surface_;
  double level_, step_;
  int top_ = 0;
  Vec3 origin_;
  std::vector<Nearest> node_;
  std::unordered_map<std::uint64_t, std::uint32_t> node_of_;
  std::vector<Leaf> leaves_;
  std::unordered_map<std::uint64_t, std::uint32_t> leaf_of_;
};

class DistanceField final : public Field {
 public:
  DistanceField(const SampleSet& samples, double offset, double spacing, const Box& box, ExecutionContext& context)
      : offset_(offset), surface_(samples, context) {
    // A distance changes its direction over about as much as itself.
    const double cells = std::abs(offset) / spacing;
    lattice_.emplace(surface_, offset, spacing, cells >= 24 ? 3 : cells >= 8 ? 2 : cells >= 2.5 ? 1 : 0, box, context);
  }

  void evaluate(const PointBatch& points, std::span<float> values) const override {
    DistanceLattice::Place place;
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<float>(lattice_->find({points.x[i], points.y[i], points.z[i]}, place).distance - offset_);
  }
  void evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx, std::span<float> dy,
                         std::span<float> dz) const override {
    DistanceLattice::Place place;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Nearest found = lattice_->find({points.x[i], points.y[i], points.z[i]}, place);
      values[i] = static_cast<float>(found.distance - offset_);
      dx[i] = static_cast<float>(found.gradient.x);
      dy[i] = static_cast<float>(found.gradient.y);
      dz[i] = static_cast<float>(found.gradient.z);
    }
  }
  Interval evaluate(const Box& box) const override {
    const double reach = 0.51 * box.diagonal();
    const int side = surface_.side_of(box.center(), offset_, reach);
    return side < 0   ? Interval{-reach, -0.01 * reach}
           : side > 0 ? Interval{0.01 * reach, reach}
                      : Interval{-2 * reach, 2 * reach};
  }
  double evaluate(const Vec3& point, Vec3* gradient) const override {
    DistanceLattice::Place place;
    const Nearest found = lattice_->find(point, place);
    if (gradient) *gradient = found.gradient;
    return found.distance - offset_;
  }
  double epsilon() const override { return 0.1 * surface_.spacing(); }

 private:
  double offset_;
  SurfaceDistance surface_;
  std::optional<DistanceLattice> lattice_;
};

}  // namespace

std::shared_ptr<const Field> distance_field(const SampleSet& samples, double offset, double spacing, const Box& box,
                                            ExecutionContext& context) {
  return std::make_shared<DistanceField>(samples, offset, spacing, box, context);
}

}  // namespace evenmesh
