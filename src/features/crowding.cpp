#include "features/crowding.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/point_hash.h"

namespace evenmesh {
namespace {

using Index = std::uint32_t;
constexpr Index none = FeatureCurve::none;

class Crowding {
 public:
  Crowding(const FeatureCurves& features, std::span<const FeatureNode> nodes, double spacing, double reach)
      : features_(features), nodes_(nodes), spacing_(spacing), reach_(reach), points_(reach) {
    PointHash near(2 * spacing);
    for (const FeatureNode& node : nodes) near.add(node.place);
    for (Index c = 0; c < features.curves.size(); ++c)
      for (Index p = 0; p < features.curves[c].points.size(); ++p) {
        const Vec3& at = features.curves[c].points[p];
        places_.push_back({c, p, nearest(near, at, 2 * spacing)});
        points_.add(at);
      }
  }

  /// The shortest first; what was taken for repeated repeats nothing itself.
  FeatureCurves unrepeated() const {
    std::vector<Index> order(features_.curves.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return features_.curves[a].length() < features_.curves[b].length(); });
    std::vector<char> repeated(features_.curves.size(), 0);
    for (const Index c : order) repeated[c] = repeats(c, repeated);
    FeatureCurves kept = without_curves(features_, repeated);
    kept.left_out = features_.left_out;  // each is there still
    return kept;
  }

  FeatureCurves resolved() const {
    std::vector<char> doomed(features_.curves.size());
    std::size_t first = 0;
    for (Index c = 0; c < features_.curves.size(); ++c) {
      doomed[c] = is_crowded(c, first);
      first += features_.curves[c].points.size();
    }
    return without_curves(features_, doomed);
  }

 private:
  struct Place {
    Index curve, point, node;  ///< node: the nearest one; none: none is near
  };

  static Index nearest(const PointHash& nodes, const Vec3& p, double reach) {
    Index best = none;
    double least = reach * reach;
    nodes.near(p, reach, [&](std::uint32_t i) {
      if (const double d = squared_norm(nodes[i] - p); d < least) {
        least = d;
        best = i;
      }
    });
    return best;
  }

  bool repeats(Index c, const std::vector<char>& repeated) const {
    const FeatureCurve& curve = features_.curves[c];
    const auto beside = [&](const Vec3& p) {
      return points_.near(p, reach_,
                          [&](std::uint32_t i) { return places_[i].curve != c && !repeated[places_[i].curve]; });
    };
    return 10 * std::count_if(curve.points.begin(), curve.points.end(), beside) >
           9 * static_cast<std::ptrdiff_t>(curve.points.size());
  }
  /// Whether a third of the curve's points, not counting those near its ends, have others beside them.
  /// @param first  its first place
  bool is_crowded(Index c, std::size_t first) const {
    const FeatureCurve& curve = features_.curves[c];
    std::size_t asked = 0, crowded = 0;
    for (Index p = 0; p < curve.points.size(); ++p) {
      const bool near_end = curve.from != none && (norm(curve.points[p] - curve.points.front()) < 1.5 * reach_ ||
                                                   norm(curve.points[p] - curve.points.back()) < 1.5 * reach_);
      if (!near_end) {
        ++asked;
        crowded += is_crowded(places_[first + p]);
      }
    }
    return 3 * crowded > asked;
  }
  Vec3 tangent(const Place& p) const {
    const auto& points = features_.curves[p.curve].points;
    const std::size_t last = points.size() - 1;
    return normalized(points[std::min<std::size_t>(p.point + 1, last)] - points[p.point > 0 ? p.point - 1 : 0]);
  }
  /// Others run beside it, none of them on the other rim of a thin part.
  bool is_crowded(const Place& p) const {
    constexpr double rim_length = 6;  // of the reach: noise has short curves
    constexpr double parallel = 0.95;
    const FeatureCurve& curve = features_.curves[p.curve];
    bool others = false, rim = false, same_place = false;
    points_.near(curve.points[p.point], reach_, [&](std::uint32_t i) {
      const Place& q = places_[i];
      const double along =
          std::abs(curve.arc[p.point] - curve.arc[std::min<std::size_t>(q.point, curve.arc.size() - 1)]);
      if (q.curve == p.curve && std::min(along, curve.length() - along) <= 4 * reach_) return;
      others = true;
      const Vec3 across = points_[i] - curve.points[p.point];
      same_place |= norm(across) < spacing_;
      if (p.node == none || q.node == none || curve.length() < rim_length * reach_) return;
      rim |= std::abs(dot(tangent(p), tangent(q))) > parallel &&
             face_apart(nodes_[p.node], nodes_[q.node], normalized(across));
    });
    return others && (same_place || !rim);
  }

  const FeatureCurves& features_;
  std::span<const FeatureNode> nodes_;
  double spacing_, reach_;
  std::vector<Place> places_;
  PointHash points_;  ///< at the places
};

}  // namespace

FeatureCurves without_crowded(const FeatureCurves& features, std::span<const FeatureNode> nodes, double spacing,
                              double reach) {
  return Crowding(features, nodes, spacing, reach).resolved();
}

FeatureCurves without_repeated(const FeatureCurves& features, double reach) {
  return Crowding(features, {}, reach, reach).unrepeated();
}

FeatureCurves without_curves(const FeatureCurves& features, const std::vector<char>& doomed) {
  FeatureCurves kept;
  kept.apexes = features.apexes;
  kept.left_out = features.left_out;
  std::vector<Index> now(features.corners.size(), none);
  const auto corner = [&](Index c) {
    if (c == none) return none;
    if (now[c] == none) {
      now[c] = static_cast<Index>(kept.corners.size());
      kept.corners.push_back(features.corners[c]);
    }
    return now[c];
  };
  for (std::size_t i = 0; i < features.curves.size(); ++i) {
    FeatureCurve curve = features.curves[i];
    if (doomed[i]) {
      kept.left_out.push_back(curve.points[curve.points.size() / 2]);
      continue;
    }
    curve.from = corner(curve.from);
    curve.to = corner(curve.to);
    kept.curves.push_back(std::move(curve));
  }
  return kept;
}

}  // namespace evenmesh
