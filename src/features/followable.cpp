#include "features/followable.h"

#include <algorithm>

#include "features/crowding.h"
#include "features/feature_seeds.h"
#include "geometry/union_find.h"

namespace evenmesh {
namespace {

using Index = std::uint32_t;

/// By curve: its length together with that of those which continue it straight on.
class Runs {
 public:
  explicit Runs(const FeatureCurves& features) : run_(features.curves.size()), lengths_(features.curves.size(), 0) {
    std::vector<std::vector<End>> at(features.corners.size());
    for (Index c = 0; c < features.curves.size(); ++c) {
      const FeatureCurve& curve = features.curves[c];
      if (curve.from == FeatureCurve::none) continue;
      const std::size_t last = curve.points.size() - 1, step = std::min<std::size_t>(2, last);
      at[curve.from].push_back({c, normalized(curve.points[step] - curve.points[0])});
      at[curve.to].push_back({c, normalized(curve.points[last - step] - curve.points[last])});
    }
    for (std::vector<End>& ends : at) join(ends);
    for (Index c = 0; c < features.curves.size(); ++c) lengths_[run_.find(c)] += features.curves[c].length();
  }

  double length(Index curve) { return lengths_[run_.find(curve)]; }

 private:
  struct End {
    Index curve;
    Vec3 away;  ///< direction in which the curve leaves the corner
  };

  /// The straightest continuations first.
  void join(std::vector<End>& ends) {
    constexpr double straight = -0.94;  // within 20°
    while (ends.size() > 1) {
      std::size_t first = 0, second = 0;
      double least = straight;
      for (std::size_t i = 0; i < ends.size(); ++i)
        for (std::size_t k = i + 1; k < ends.size(); ++k)
          if (const double cosine = dot(ends[i].away, ends[k].away); cosine < least) {
            least = cosine;
            first = i;
            second = k;
          }
      if (second == 0) return;
      run_.unite(ends[first].curve, ends[second].curve);
      ends.erase(ends.begin() + static_cast<std::ptrdiff_t>(second));
      ends.erase(ends.begin() + static_cast<std::ptrdiff_t>(first));
    }
  }

  UnionFind run_;
  std::vector<double> lengths_;
};

/// Whether the mesh would have hardly anything but corners along its curves.
/// @param share  seeds for a corner, at least
bool is_web(const FeatureCurves& features, std::size_t seeds, std::size_t share) {
  constexpr std::size_t many_corners = 100;
  return features.corners.size() > many_corners && share * features.corners.size() > seeds;
}

}  // namespace

FeatureCurves followable(const FeatureCurves& features, double edge, std::size_t most) {
  constexpr double growth = 1.25;
  FeatureCurves kept = features;
  Runs runs(features);
  for (double limit = edge;; limit *= growth) {
    const std::size_t seeds = place_feature_seeds(kept, edge).size();
    // What begins to be left out is left out well below the limit: at it, meshes suffer.
    const std::size_t caution = kept.curves.size() < features.curves.size() ? 2 : 1;
    if (caution * seeds <= most && !is_web(kept, seeds, 2 * caution)) break;
    std::vector<char> doomed(features.curves.size());
    for (Index c = 0; c < doomed.size(); ++c) doomed[c] = runs.length(c) <= limit;
    kept = without_curves(features, doomed);
  }
  if (kept.curves.empty()) kept.apexes.clear();
  return kept;
}

}  // namespace evenmesh
