#include "features/feature_seeds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <unordered_map>

#include "geometry/segment.h"
#include "grid/morton.h"

namespace evenmesh {
namespace {

constexpr double held_distance = 1.5;  ///< grid cells

/// A piece of a curve, between its points `point` and `point` + 1.
struct Segment {
  std::uint32_t curve, point;
};

/// The segments near every brick of the grid.
class SegmentIndex {
 public:
  SegmentIndex(const Grid& grid, const FeatureCurves& features, double reach) {
    const double side = brick_size * grid.spacing;
    for (std::uint32_t c = 0; c < features.curves.size(); ++c) {
      const auto& points = features.curves[c].points;
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

/// The seed of curve c at the length s along it.
std::uint32_t seed_at(const FeatureCurves& features, const FeatureSeeds& seeds, std::uint32_t c, double s) {
  const FeatureCurve& curve = features.curves[c];
  const std::uint32_t n = seeds.segments[c];
  const auto k = static_cast<std::uint32_t>(std::lround(std::clamp(s / curve.length(), 0.0, 1.0) * n));
  if (curve.from == FeatureCurve::none) return seeds.first[c] + k % n;
  return k == 0 ? curve.from : k == n ? curve.to : seeds.first[c] + k - 1;
}

/// Point at the length s along a curve.
Vec3 point_at(const FeatureCurve& curve, double s) {
  const auto after =
      std::clamp<std::ptrdiff_t>(std::upper_bound(curve.arc.begin(), curve.arc.end(), s) - curve.arc.begin(), 1,
                                 static_cast<std::ptrdiff_t>(curve.arc.size()) - 1);
  const auto i = static_cast<std::size_t>(after);
  const double step = curve.arc[i] - curve.arc[i - 1], share = step > 0 ? (s - curve.arc[i - 1]) / step : 0;
  return curve.points[i - 1] + share * (curve.points[i] - curve.points[i - 1]);
}

/// Largest distance of the curve's points from the chords of n equal pieces.
double deviation(const FeatureCurve& curve, std::uint32_t n) {
  double worst = 0;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const double piece = std::min(std::floor(curve.arc[i] / curve.length() * n), n - 1.0);
    const Vec3 a = point_at(curve, curve.length() * piece / n), b = point_at(curve, curve.length() * (piece + 1) / n);
    const Vec3 along = normalized(b - a), from = curve.points[i] - a;
    worst = std::max(worst, norm(from - dot(from, along) * along));
  }
  return worst;
}

/// Into how many pieces a curve is cut: of the length `edge`, or a little less where it is bent so much that chords
/// would leave it.
std::uint32_t segments_of(const FeatureCurve& curve, double edge) {
  const std::uint32_t least = curve.from == curve.to ? 3 : 1;
  auto n = std::max(least, static_cast<std::uint32_t>(std::lround(curve.length() / edge)));
  for (const std::uint32_t most = n + (n + 1) / 2; n < most && deviation(curve, n) > feature_deviation * edge;) ++n;
  return n;
}

/// @param segments  by curve: into how many pieces it is cut
FeatureSeeds place(const FeatureCurves& features, std::vector<std::uint32_t> segments) {
  FeatureSeeds seeds;
  seeds.segments = std::move(segments);
  const auto add = [&](const Vec3& p, Attachment::Kind kind, std::uint32_t index) {
    seeds.seeds.positions.push_back(p);
    seeds.seeds.fixed.push_back({kind, index});
  };
  for (std::uint32_t c = 0; c < features.corners.size(); ++c) add(features.corners[c], Attachment::Kind::corner, c);
  for (std::uint32_t c = 0; c < features.curves.size(); ++c) {
    const FeatureCurve& curve = features.curves[c];
    const std::uint32_t n = seeds.segments[c];
    seeds.first.push_back(static_cast<std::uint32_t>(seeds.size()));
    for (std::uint32_t k = curve.from == FeatureCurve::none ? 0 : 1; k < n; ++k)
      add(point_at(curve, curve.length() * k / n), Attachment::Kind::curve, c);
    const double piece = curve.length() / n;
    for (std::uint32_t k = 0; k < n; ++k)
      seeds.edges.push_back({seed_at(features, seeds, c, piece * k), seed_at(features, seeds, c, piece * (k + 1))});
  }
  return seeds;
}

}  // namespace

bool follows(const FeatureCurve& curve, double edge) {
  return deviation(curve, segments_of(curve, edge)) <= feature_deviation * edge;
}

FeatureSeeds place_feature_seeds(const FeatureCurves& features, double edge) {
  std::vector<std::uint32_t> segments;
  std::set<std::pair<std::uint32_t, std::uint32_t>> joined;  // corners with an edge between them
  for (const FeatureCurve& curve : features.curves) {
    segments.push_back(segments_of(curve, edge));
    if (segments.back() == 1 && !joined.insert(std::minmax(curve.from, curve.to)).second) segments.back() = 2;
  }
  return place(features, std::move(segments));
}

FeatureSeeds halve_spacing(const FeatureCurves& features, const FeatureSeeds& coarse) {
  std::vector<std::uint32_t> segments = coarse.segments;
  for (std::uint32_t& n : segments) n *= 2;
  return place(features, std::move(segments));
}

void constrain_labels(const SampleSet& samples, const FeatureCurves& features, const FeatureSeeds& seeds,
                      std::vector<std::uint32_t>& labels, ExecutionContext& context) {
  const double reach = held_distance * samples.grid.spacing;
  const SegmentIndex index(samples.grid, features, reach + samples.grid.spacing);
  const auto label_near = [&](const Vec3& p, std::span<const Segment> segments, std::uint32_t label) {
    double nearest = reach * reach;
    for (const auto& [c, i] : segments) {
      const FeatureCurve& curve = features.curves[c];
      const SegmentPoint on = closest_point_on_segment(p, curve.points[i], curve.points[i + 1]);
      if (on.squared_distance >= nearest) continue;
      nearest = on.squared_distance;
      label = seed_at(features, seeds, c, curve.arc[i] + on.share * (curve.arc[i + 1] - curve.arc[i]));
    }
    return label;
  };
  parallel_for(context, samples.blocks.size(), 32, [&](std::size_t begin, std::size_t end) {
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
