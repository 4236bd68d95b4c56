#include "features/crowding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace evenmesh {
namespace {

using Index = std::uint32_t;
constexpr Index none = FeatureCurve::none;

class Crowding {
 public:
  Crowding(const FeatureCurves& features, double reach) : features_(features), reach_(reach) {
    for (Index c = 0; c < features.curves.size(); ++c)
      for (Index p = 0; p < features.curves[c].points.size(); ++p) cells_[cell(at({c, p}))].push_back({c, p});
  }

  FeatureCurves resolved() const {
    std::vector<char> doomed(features_.curves.size());
    for (Index c = 0; c < features_.curves.size(); ++c) doomed[c] = is_crowded(c);
    return without_curves(features_, doomed);
  }

 private:
  struct Place {
    Index curve, point;
  };
  using Cell = std::array<std::int64_t, 3>;
  const Vec3& at(Place p) const { return features_.curves[p.curve].points[p.point]; }
  Cell cell(const Vec3& p) const {
    return {std::int64_t(std::floor(p.x / reach_)), std::int64_t(std::floor(p.y / reach_)),
            std::int64_t(std::floor(p.z / reach_))};
  }

  /// Whether a third of the chain's points, not counting those near its ends, have others beside them.
  bool is_crowded(Index c) const {
    const FeatureCurve& curve = features_.curves[c];
    std::size_t asked = 0, crowded = 0;
    for (Index p = 0; p < curve.points.size(); ++p) {
      const bool near_end = curve.from != none && (norm(curve.points[p] - curve.points.front()) < 1.5 * reach_ ||
                                                   norm(curve.points[p] - curve.points.back()) < 1.5 * reach_);
      if (!near_end) ++asked, crowded += has_other_beside({c, p});
    }
    return 3 * crowded > asked;
  }
  bool has_other_beside(Place p) const {
    const FeatureCurve& curve = features_.curves[p.curve];
    const Cell home = cell(at(p));
    for (int d = 0; d < 27; ++d) {
      const auto it = cells_.find({home[0] + d % 3 - 1, home[1] + d / 3 % 3 - 1, home[2] + d / 9 - 1});
      if (it == cells_.end()) continue;
      for (const Place q : it->second) {
        if (squared_norm(at(q) - at(p)) >= reach_ * reach_) continue;
        const double along =
            std::abs(curve.arc[p.point] - curve.arc[std::min<std::size_t>(q.point, curve.arc.size() - 1)]);
        if (q.curve != p.curve || std::min(along, curve.length() - along) > 4 * reach_) return true;
      }
    }
    return false;
  }

  const FeatureCurves& features_;
  double reach_;
  std::map<Cell, std::vector<Place>> cells_;
};

}  // namespace

FeatureCurves without_crowded(const FeatureCurves& features, double reach) {
  return Crowding(features, reach).resolved();
}

FeatureCurves without_curves(const FeatureCurves& features, const std::vector<char>& doomed) {
  FeatureCurves kept;
  kept.apexes = features.apexes;
  std::vector<Index> now(features.corners.size(), none);
  const auto corner = [&](Index c) {
    if (c == none) return none;
    if (now[c] == none) now[c] = static_cast<Index>(kept.corners.size()), kept.corners.push_back(features.corners[c]);
    return now[c];
  };
  for (std::size_t i = 0; i < features.curves.size(); ++i) {
    if (doomed[i]) continue;
    FeatureCurve curve = features.curves[i];
    curve.from = corner(curve.from), curve.to = corner(curve.to);
    kept.curves.push_back(std::move(curve));
  }
  return kept;
}

}  // namespace evenmesh
