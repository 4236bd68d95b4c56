#include "sample/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

#include "geometry/closest_point.h"
#include "geometry/triangle.h"
#include "sample/dual_surface.h"
#include "sample/inside_runs.h"
#include "sample/morton.h"

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
  SurfaceDistance(const SampleSet& samples, Run& run) : grid_(samples.grid), inside_(samples, run) {
    const Mesh mesh = dual_surface(samples, run);
    normal_.resize(mesh.triangles.size());
    for (std::size_t t = 0; t < normal_.size(); ++t) {
      const auto [a, b, c] = corners_of(mesh, t);
      normal_[t] = pack_normal(normalized(area_normal(a, b, c)));
    }
    query_.emplace(mesh, run);
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

/// Exact distances at the nodes of a lattice around one level, and what they say in between.
///
/// A query far from the surface looks at all triangles of a lens as wide as the way is long. Between nodes the distance
/// is smooth: the mean of the interpolated distances and of the interpolated tangent planes is exact to second order.
/// Where the nodes see different pieces of surface, it is asked for.
class DistanceLattice {
 public:
  DistanceLattice(const SurfaceDistance& surface, double level, double step, const Box& box, Run& run)
      : surface_(surface), level_(level), step_(step), origin_(box.lo) {
    std::uint32_t side = 1;  // in steps
    while (side * step < box.longest_side()) side *= 2;
    Cells cells{{0, 0, 0}};
    for (keep_near_level(cells, side, box, run); side > 1; keep_near_level(cells, side, box, run))
      side /= 2, split(cells, side);
    std::vector<std::uint64_t> keys;
    for (const auto& c : cells)
      for (unsigned corner = 0; corner < 8; ++corner)
        keys.push_back(morton_code(c[0] + (corner & 1), c[1] + (corner >> 1 & 1), c[2] + (corner >> 2)));
    parallel_sort(run, keys);
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    node_.resize(keys.size());
    index_.reserve(2 * keys.size());
    for (std::uint32_t n = 0; n < keys.size(); ++n) index_.emplace(keys[n], n);
    parallel_for(run, keys.size(), 64, [&](std::size_t begin, std::size_t end) {
      Vec3 last;
      double bound = std::abs(level_) + 3 * step_;
      for (std::size_t n = begin; n < end; ++n) {
        const auto at = morton_decode(keys[n]);
        const Vec3 p = origin_ + step_ * Vec3{double(at[0]), double(at[1]), double(at[2])};
        node_[n] = surface_.find(p, n == begin ? bound : bound + norm(p - last) * (1 + 1e-6) + 1e-9 * step_);
        bound = std::abs(node_[n].distance), last = p;
      }
    });
  }

  /// One lattice cell's nodes; remembers the last, since points come in rows.
  struct Cell {
    std::array<std::int64_t, 3> at{-1, -1, -1};
    std::array<const Nearest*, 8> node{};
    bool known = false, smooth = false;
  };
  /// @returns nothing where the lattice does not reach: there the level is far away
  std::optional<Nearest> find(const Vec3& p, Cell& cell) const {
    const Vec3 at = (p - origin_) / step_;
    const std::array<std::int64_t, 3> corner{static_cast<std::int64_t>(std::floor(at.x)),
                                             static_cast<std::int64_t>(std::floor(at.y)),
                                             static_cast<std::int64_t>(std::floor(at.z))};
    if (corner != cell.at) enter(corner, cell);
    if (!cell.known) return std::nullopt;
    return cell.smooth ? interpolated(p, at, cell) : nearest_of(p, cell);
  }

 private:
  using Cells = std::vector<std::array<std::uint32_t, 3>>;  ///< lower corners, in steps

  static void split(Cells& cells, std::uint32_t half) {
    Cells parts;
    parts.reserve(8 * cells.size());
    for (const auto& c : cells)
      for (std::uint32_t part = 0; part < 8; ++part)
        parts.push_back({c[0] + (part & 1) * half, c[1] + (part >> 1 & 1) * half, c[2] + (part >> 2) * half});
    cells.swap(parts);
  }
  /// Those cells that may hold the level.
  void keep_near_level(Cells& cells, std::uint32_t side, const Box& box, const Run& run) const {
    std::vector<char> keep(cells.size());
    parallel_for(run, cells.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 lo = origin_ + step_ * Vec3{double(cells[i][0]), double(cells[i][1]), double(cells[i][2])};
        if (lo.x > box.hi.x || lo.y > box.hi.y || lo.z > box.hi.z) continue;
        keep[i] = surface_.side_of(lo + 0.5 * side * step_ * Vec3{1, 1, 1}, level_, (0.87 * side + 0.2) * step_) == 0;
      }
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (keep[i]) cells[kept++] = cells[i];
    cells.resize(kept);
  }

  void enter(const std::array<std::int64_t, 3>& corner, Cell& cell) const {
    cell.at = corner;
    cell.known = false;
    if (corner[0] < 0 || corner[1] < 0 || corner[2] < 0) return;
    for (unsigned c = 0; c < 8; ++c) {
      const auto found =
          index_.find(morton_code(std::uint64_t(corner[0]) + (c & 1), std::uint64_t(corner[1]) + (c >> 1 & 1),
                                  std::uint64_t(corner[2]) + (c >> 2)));
      if (found == index_.end()) return;
      cell.node[c] = &node_[found->second];
    }
    cell.known = true;
    cell.smooth = std::all_of(cell.node.begin(), cell.node.end(),
                              [&](const Nearest* n) { return dot(n->gradient, cell.node[0]->gradient) > same_way; });
  }
  Nearest interpolated(const Vec3& p, const Vec3& at, const Cell& cell) const {
    Nearest result;
    Vec3 gradient;
    double by_value = 0, by_plane = 0;
    for (unsigned c = 0; c < 8; ++c) {
      const std::array<double, 3> corner{double(cell.at[0] + (c & 1)), double(cell.at[1] + (c >> 1 & 1)),
                                         double(cell.at[2] + (c >> 2))};
      double weight = 1;
      for (int a = 0; a < 3; ++a) weight *= 1 - std::abs(at[a] - corner[std::size_t(a)]);
      const Nearest& node = *cell.node[c];
      const Vec3 x = origin_ + step_ * Vec3{corner[0], corner[1], corner[2]};
      by_value += weight * node.distance;
      by_plane += weight * (node.distance + dot(node.gradient, p - x));
      gradient += weight * node.gradient;
    }
    result.distance = 0.5 * (by_value + by_plane);
    result.gradient = normalized(gradient);
    return result;
  }
  /// Exactly; the nodes' nearest points bound the search.
  Nearest nearest_of(const Vec3& p, const Cell& cell) const {
    double bound = std::numeric_limits<double>::infinity();
    for (const Nearest* node : cell.node) bound = std::min(bound, squared_norm(p - node->point));
    return surface_.find(p, std::sqrt(bound) * (1 + 1e-6) + 1e-9 * step_);
  }

  const SurfaceDistance& surface_;
  double level_, step_;
  Vec3 origin_;
  std::vector<Nearest> node_;
  std::unordered_map<std::uint64_t, std::uint32_t> index_;
};

class DistanceField final : public Field {
 public:
  DistanceField(const SampleSet& samples, double offset, double spacing, const Box& box, Run& run)
      : offset_(offset), surface_(samples, run) {
    // A distance changes its direction over about as much as itself.
    const double cells = std::abs(offset) / spacing;
    lattice_.emplace(surface_, offset, (cells >= 24 ? 8 : cells >= 8 ? 4 : cells >= 2.5 ? 2 : 1) * spacing, box, run);
  }

  void evaluate(const PointBatch& points, std::span<float> values) const override {
    DistanceLattice::Cell cell;
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<float>(find({points.x[i], points.y[i], points.z[i]}, cell).distance - offset_);
  }
  void evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx, std::span<float> dy,
                         std::span<float> dz) const override {
    DistanceLattice::Cell cell;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Nearest found = find({points.x[i], points.y[i], points.z[i]}, cell);
      values[i] = static_cast<float>(found.distance - offset_);
      dx[i] = static_cast<float>(found.gradient.x), dy[i] = static_cast<float>(found.gradient.y),
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
    DistanceLattice::Cell cell;
    const Nearest found = find(point, cell);
    if (gradient) *gradient = found.gradient;
    return found.distance - offset_;
  }
  double epsilon() const override { return 0.1 * surface_.spacing(); }

 private:
  Nearest find(const Vec3& p, DistanceLattice::Cell& cell) const {
    if (const auto found = lattice_->find(p, cell)) return *found;
    // So far from the level that only its side matters.
    const int side = surface_.side_of(p, offset_, 0);
    return {p, {1, 0, 0}, offset_ + (side < 0 ? -1 : 1) * 8 * surface_.spacing()};
  }

  double offset_;
  SurfaceDistance surface_;
  std::optional<DistanceLattice> lattice_;
};

}  // namespace

std::shared_ptr<const Field> distance_field(const SampleSet& samples, double offset, double spacing, const Box& box,
                                            Run& run) {
  return std::make_shared<DistanceField>(samples, offset, spacing, box, run);
}

}  // namespace evenmesh
