#include "features/apexes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "geometry/point_hash.h"
#include "grid/morton.h"

namespace evenmesh {
namespace {

constexpr double around = 1;            ///< edges: so far the planes go through the apex, and nothing else comes near
constexpr double max_residual = 0.005;  ///< of a plane's distance from the apex, root of the mean square, in edges
constexpr double max_missing = 4;       ///< grid cells from the apex to the nearest sample: needles are seen cut off
constexpr double apart = 0.5;           ///< edges: nearer to feature curves, and to each other, none are looked for
constexpr std::size_t max_candidates = 2000;

class TipFinder {
 public:
  TipFinder(const SampleSet& samples, double angle, double edge)
      : samples_(samples), max_mean_(std::cos(angle * std::numbers::pi / 180)), edge_(edge) {}

  /// The apex that is near to p, if there is one.
  std::optional<Vec3> near(Vec3 p) const {
    for (int step = 0; step < 3; ++step) {
      Quadric planes;
      each_around(p, [&](const Vec3& x, const Vec3& n) { planes.add_plane(x - p, n); });
      if (planes.rank() < 3) return {};  // a feature curve at most, or nothing
      const Vec3 move = planes.minimum(3, 3);
      if (!(norm(move) < around * edge_)) return {};
      p += move;
    }
    return is_apex(p) ? std::optional(p) : std::nullopt;
  }

 private:
  bool is_apex(const Vec3& p) const {
    double count = 0, squares = 0, nearest = around * edge_;
    Vec3 sum;
    each_around(p, [&](const Vec3& x, const Vec3& n) {
      const double off = dot(n, p - x);
      count += 1;
      squares += off * off;
      sum += n;
      nearest = std::min(nearest, norm(x - p));
    });
    return count > 0 && nearest < max_missing * samples_.grid.spacing && norm(sum) < max_mean_ * count &&
           squares < max_residual * max_residual * edge_ * edge_ * count;
  }

  /// Whether some sample of a brick may be nearer to p.
  bool reaches(const Vec3& p, const std::array<std::int64_t, 3>& brick, double reach) const {
    double squares = 0;
    for (int a = 0; a < 3; ++a) {
      const double h = samples_.grid.spacing, lo = samples_.grid.origin[a] + h * (8.0 * double(brick[a]) - 0.1);
      const double off = std::max({lo - p[a], p[a] - lo - 8.2 * h, 0.0});
      squares += off * off;
    }
    return squares < reach * reach;
  }

  /// Calls visit(place, normal) for the samples nearer to p than `around`.
  template <typename Visit>
  void each_around(const Vec3& p, const Visit& visit) const {
    const double reach = around * edge_, side = brick_size * samples_.grid.spacing;
    std::array<std::int64_t, 3> lo{}, hi{};
    for (int a = 0; a < 3; ++a) {
      // Edges reach one cell beyond their brick.
      const double at = p[a] - samples_.grid.origin[a];
      lo[a] = std::max<std::int64_t>(0, std::int64_t(std::floor((at - reach - samples_.grid.spacing) / side)));
      hi[a] = std::int64_t(std::floor((at + reach) / side));
    }
    for (std::int64_t k = lo[2]; k <= hi[2]; ++k)
      for (std::int64_t j = lo[1]; j <= hi[1]; ++j)
        for (std::int64_t i = lo[0]; i <= hi[0]; ++i) {
          if (!reaches(p, {i, j, k}, reach)) continue;
          const std::uint64_t code = morton_code(std::uint64_t(i), std::uint64_t(j), std::uint64_t(k));
          const auto block = std::lower_bound(samples_.blocks.begin(), samples_.blocks.end(), code,
                                              [](const SampleBlock& b, std::uint64_t c) {
                                                return morton_code(b.brick[0], b.brick[1], b.brick[2]) < c;
                                              });
          if (block == samples_.blocks.end() || morton_code(block->brick[0], block->brick[1], block->brick[2]) != code)
            continue;
          visit_block(*block, p, reach, visit);
        }
  }

  /// Most are too far, which single precision is enough to tell.
  template <typename Visit>
  void visit_block(const SampleBlock& block, const Vec3& p, double reach, const Visit& visit) const {
    constexpr std::uint32_t batch = 64;
    const Vec3 center = samples_.block_center(block), from = p - center;
    const float px = static_cast<float>(from.x), py = static_cast<float>(from.y), pz = static_cast<float>(from.z);
    const auto limit = static_cast<float>(1.001 * reach * reach);
    for (std::uint32_t begin = block.begin; begin < block.end; begin += batch) {
      const std::uint32_t count = std::min(batch, block.end - begin);
      const float *x = &samples_.x[begin], *y = &samples_.y[begin], *z = &samples_.z[begin];
      std::array<float, batch> far;
      for (std::uint32_t s = 0; s < count; ++s)
        far[s] = (x[s] - px) * (x[s] - px) + (y[s] - py) * (y[s] - py) + (z[s] - pz) * (z[s] - pz);
      for (std::uint32_t s = 0; s < count; ++s) {
        if (far[s] > limit) continue;
        const Vec3 place = center + Vec3{x[s], y[s], z[s]};
        if (squared_norm(place - p) < reach * reach) visit(place, unpack_normal(samples_.normal[begin + s]));
      }
    }
  }

  const SampleSet& samples_;
  double max_mean_;  ///< length of the mean normal
  double edge_;
};

/// Whether points lie in the cell of p or beside it: all nearer than a cell's side, and some up to twice as far.
bool is_beside(const PointHash& points, const Vec3& p, double side) {
  const Vec3 reach{side, side, side};
  return points.in_cells({p - reach, p + reach}, [](std::uint32_t) { return true; });
}

}  // namespace

std::vector<Vec3> find_apexes(const SampleSet& samples, std::span<const FeatureNode> nodes,
                              const FeatureCurves& features, double angle, double edge, ExecutionContext& context) {
  PointHash taken(apart * edge, samples.grid.origin);
  for (const FeatureCurve& curve : features.curves)
    for (const Vec3& p : curve.points) taken.add(p);
  std::vector<Vec3> candidates;
  for (const FeatureNode& node : nodes) {
    if (is_beside(taken, node.place, apart * edge)) continue;
    taken.add(node.place);
    candidates.push_back(node.place);
    if (candidates.size() > max_candidates) return {};
  }
  const TipFinder finder(samples, angle, edge);
  std::vector<std::optional<Vec3>> found(candidates.size());
  parallel_for(context, candidates.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) found[c] = finder.near(candidates[c]);
  });
  std::vector<Vec3> apexes;
  for (const auto& apex : found)
    if (apex &&
        std::none_of(apexes.begin(), apexes.end(), [&](const Vec3& q) { return norm(q - *apex) < around * edge; }))
      apexes.push_back(*apex);
  return apexes;
}

}  // namespace evenmesh
