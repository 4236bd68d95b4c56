#include "features/feature_seeds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <unordered_map>

#include "grid/morton.h"

namespace evenmesh {
namespace {

constexpr double held_distance = 1.5;  ///< grid cells

/// A piece of a chain, between its points `point` and `point` + 1.
struct Segment {
  std::uint32_t chain, point;
};

/// The segments near every brick of the grid.
class SegmentIndex {
 public:
  SegmentIndex(const Grid& grid, const Creases& creases, double reach) {
    const double side = brick_size * grid.spacing;
    for (std::uint32_t c = 0; c < creases.chains.size(); ++c) {
      const auto& points = creases.chains[c].points;
      for (std::uint32_t p = 0; p + 1 < points.size(); ++p) {
        std::array<std::int64_t, 3> lo{}, hi{};
        for (int a = 0; a < 3; ++a) {
          const double low = std::min(points[p][a], points[p + 1][a]), high = std::max(points[p][a], points[p + 1][a]);
          lo[a] = std::max<std::int64_t>(0, std::int64_t(std::floor((low - reach - grid.origin[a]) / side)));
          hi[a] = std::int64_t(std::floor((high + reach - grid.origin[a]) / side));
        }
        for (std::int64_t k = lo[2]; k <= hi[2]; ++k)
          for (std::int64_t j = lo[1]; j <= hi[1]; ++j)
            for (std::int64_t i = lo[0]; i <= hi[0]; ++i)
              of_brick_[morton_code(std::uint64_t(i), std::uint64_t(j), std::uint64_t(k))].push_back({c, p});
      }
    }
  }
  std::span<const Segment> of_brick(const std::array<std::uint16_t, 3>& brick) const {
    const auto it = of_brick_.find(morton_code(brick[0], brick[1], brick[2]));
    return it == of_brick_.end() ? std::span<const Segment>{} : std::span<const Segment>(it->second);
  }

 private:
  std::unordered_map<std::uint64_t, std::vector<Segment>> of_brick_;
};

/// The seed of chain c at the length s along it.
std::uint32_t seed_at(const Creases& creases, const CreaseSeeds& seeds, std::uint32_t c, double s) {
  const CreaseChain& chain = creases.chains[c];
  const std::uint32_t n = seeds.segments[c];
  const auto k = static_cast<std::uint32_t>(std::lround(std::clamp(s / chain.length(), 0.0, 1.0) * n));
  if (chain.from == CreaseChain::none) return seeds.first[c] + k % n;
  return k == 0 ? chain.from : k == n ? chain.to : seeds.first[c] + k - 1;
}

/// Point at the length s along a chain.
Vec3 point_at(const CreaseChain& chain, double s) {
  const auto after =
      std::clamp<std::ptrdiff_t>(std::upper_bound(chain.arc.begin(), chain.arc.end(), s) - chain.arc.begin(), 1,
                                 static_cast<std::ptrdiff_t>(chain.arc.size()) - 1);
  const auto i = static_cast<std::size_t>(after);
  const double step = chain.arc[i] - chain.arc[i - 1], share = step > 0 ? (s - chain.arc[i - 1]) / step : 0;
  return chain.points[i - 1] + share * (chain.points[i] - chain.points[i - 1]);
}

/// Largest distance of the chain's points from the chords of n equal pieces.
double deviation(const CreaseChain& chain, std::uint32_t n) {
  double worst = 0;
  for (std::size_t i = 0; i < chain.points.size(); ++i) {
    const double piece = std::min(std::floor(chain.arc[i] / chain.length() * n), n - 1.0);
    const Vec3 a = point_at(chain, chain.length() * piece / n), b = point_at(chain, chain.length() * (piece + 1) / n);
    const Vec3 along = normalized(b - a), from = chain.points[i] - a;
    worst = std::max(worst, norm(from - dot(from, along) * along));
  }
  return worst;
}

/// Into how many pieces a chain is cut: of the length `edge`, or a little less where it is bent so much that chords
/// would leave it.
std::uint32_t segments_of(const CreaseChain& chain, double edge) {
  const std::uint32_t least = chain.from == chain.to ? 3 : 1;
  auto n = std::max(least, static_cast<std::uint32_t>(std::lround(chain.length() / edge)));
  for (const std::uint32_t most = n + (n + 1) / 2; n < most && deviation(chain, n) > crease_deviation * edge;) ++n;
  return n;
}

}  // namespace

std::uint32_t CreaseSeeds::chain_of(std::size_t place) const {
  return static_cast<std::uint32_t>(std::upper_bound(first.begin(), first.end(), place) - first.begin() - 1);
}

bool follows(const CreaseChain& chain, double edge) {
  return deviation(chain, segments_of(chain, edge)) <= crease_deviation * edge;
}

CreaseSeeds place_crease_seeds(const Creases& creases, double edge) {
  CreaseSeeds seeds;
  seeds.places = creases.corners, seeds.corners = creases.corners.size();
  std::set<std::pair<std::uint32_t, std::uint32_t>> joined;  // corners with an edge between them
  for (std::uint32_t c = 0; c < creases.chains.size(); ++c) {
    const CreaseChain& chain = creases.chains[c];
    const bool closed = chain.from == CreaseChain::none;
    std::uint32_t n = segments_of(chain, edge);
    if (n == 1 && !joined.insert(std::minmax(chain.from, chain.to)).second) n = 2;
    const auto first = static_cast<std::uint32_t>(seeds.places.size());
    seeds.first.push_back(first), seeds.segments.push_back(n);
    for (std::uint32_t k = closed ? 0 : 1; k < n; ++k) seeds.places.push_back(point_at(chain, chain.length() * k / n));
    for (std::uint32_t k = 0; k < n; ++k) {
      const double at = chain.length() / n;
      seeds.edges.push_back({seed_at(creases, seeds, c, at * k), seed_at(creases, seeds, c, at * (k + 1))});
    }
  }
  return seeds;
}

void hold_labels(const SampleSet& samples, const Creases& creases, const CreaseSeeds& seeds,
                 std::vector<std::uint32_t>& labels, Run& run) {
  const double reach = held_distance * samples.grid.spacing;
  const SegmentIndex index(samples.grid, creases, reach + samples.grid.spacing);
  const auto label_near = [&](const Vec3& p, std::span<const Segment> segments, std::uint32_t label) {
    double nearest = reach * reach;
    for (const auto& [c, i] : segments) {
      const CreaseChain& chain = creases.chains[c];
      const Vec3 along = chain.points[i + 1] - chain.points[i], from = p - chain.points[i];
      const double length2 = squared_norm(along);
      const double share = length2 > 0 ? std::clamp(dot(from, along) / length2, 0.0, 1.0) : 0;
      const double distance = squared_norm(from - share * along);
      if (distance >= nearest) continue;
      nearest = distance;
      label = seed_at(creases, seeds, c, chain.arc[i] + share * (chain.arc[i + 1] - chain.arc[i]));
    }
    return label;
  };
  parallel_for(run, samples.blocks.size(), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const SampleBlock& block = samples.blocks[b];
      const auto segments = index.of_brick(block.brick);
      if (segments.empty()) continue;
      const Vec3 center = samples.block_center(block);
      for (std::uint32_t s = block.begin; s < block.end; ++s)
        labels[s] = label_near(center + Vec3{samples.x[s], samples.y[s], samples.z[s]}, segments, labels[s]);
    }
  });
}

}  // namespace evenmesh
