#include "features/feature_curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "features/apexes.h"
#include "features/crowding.h"
#include "features/edge_graph.h"
#include "features/feature_network.h"
#include "features/feature_seeds.h"

namespace evenmesh {
namespace {

using Index = std::uint32_t;
constexpr Index none = FeatureCurve::none;
constexpr double crowded_distance = 0.33;  ///< of curves side by side, in edges
constexpr double max_tightened = 1.5;      ///< how much denser vertices are there than elsewhere, at most
constexpr double sharp_turn = 40;          ///< degrees within a few grid cells: a corner

/// Makes curves of the network's paths.
class Chains {
 public:
  Chains(double edge, double spacing) : edge_(edge), spacing_(spacing) {}

  FeatureCurves make(const FeatureNetwork& network) {
    for (const FeaturePath& path : network.paths) {
      if (path.from == none) {
        add(thinned(path.points, 0.8 * spacing_), none, none);
        continue;
      }
      const Index from = corner_at(network, path.from), to = corner_at(network, path.to);
      add(clear_of_ends(path.points), from, to);
    }
    return std::move(features_);
  }

 private:
  Index corner_at(const FeatureNetwork& network, Index junction) {
    const auto [it, added] = corner_of_.insert({junction, static_cast<Index>(features_.corners.size())});
    if (added) features_.corners.push_back(network.junctions[junction]);
    return it->second;
  }

  /// Near a corner the planes of cubes are mixed: the way to it is straight.
  std::vector<PolylinePoint> clear_of_ends(const std::vector<PolylinePoint>& points) const {
    const Vec3 a = points.front().place, b = points.back().place;
    const double clear = 1.2 * spacing_;
    std::vector<PolylinePoint> kept{points.front()};
    for (std::size_t i = 1; i + 1 < points.size(); ++i)
      if (norm(points[i].place - a) > clear && norm(points[i].place - b) > clear) kept.push_back(points[i]);
    kept.push_back(points.back());
    return thinned(kept, 0.8 * spacing_);
  }

  /// Adds the points as one curve, or as several if there are turns in it.
  void add(std::vector<PolylinePoint> points, Index from, Index to) {
    const bool closed = from == none;
    const double reach = std::max(3 * spacing_, 0.25 * edge_);
    const Polyline line(points, closed);
    const std::vector<std::size_t> turns = line.turns(sharp_turn, reach);
    if (turns.empty()) return add_curve(points, from, to);
    std::vector<Index> corners;
    for (const std::size_t i : turns) {
      corners.push_back(static_cast<Index>(features_.corners.size()));
      features_.corners.push_back(line.corner(i, reach, 3.5 * spacing_));
      points[i].place = features_.corners.back();
    }
    const auto piece = [&](std::size_t begin, std::size_t end) {
      return std::vector<PolylinePoint>(points.begin() + static_cast<std::ptrdiff_t>(begin),
                                        points.begin() + static_cast<std::ptrdiff_t>(end) + 1);
    };
    const std::size_t last = points.size() - 1;
    std::vector<PolylinePoint> head = piece(0, turns.front()), tail = piece(turns.back(), last);
    if (closed) {
      tail.insert(tail.end(), head.begin() + 1, head.end());
      add_curve(clear_of_ends(tail), corners.back(), corners.front());
    } else {
      add_curve(clear_of_ends(head), from, corners.front());
      add_curve(clear_of_ends(tail), corners.back(), to);
    }
    for (std::size_t k = 0; k + 1 < turns.size(); ++k)
      add_curve(clear_of_ends(piece(turns[k], turns[k + 1])), corners[k], corners[k + 1]);
  }

  void add_curve(std::vector<PolylinePoint> points, Index from, Index to) {
    FeatureCurve curve = curve_of(points, from, to);
    if (!(curve.points.size() > 1 && curve.length() > 0)) return;
    if (!follows(curve, edge_)) {
      tighten(points, from == none);
      curve = curve_of(points, from, to);
    }
    features_.curves.push_back(std::move(curve));
  }
  static FeatureCurve curve_of(const std::vector<PolylinePoint>& points, Index from, Index to) {
    FeatureCurve curve;
    curve.from = from;
    curve.to = to;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double step = i == 0 ? 0
                                 : 0.5 * (points[i - 1].relative_sizing + points[i].relative_sizing) *
                                       norm(points[i].place - points[i - 1].place);
      curve.points.push_back(points[i].place);
      curve.arc.push_back((i == 0 ? 0 : curve.arc.back()) + step);
    }
    return curve;
  }

  /// Quickens the pace in strongly curved parts so that chords do not leave them by more than `feature_deviation`.
  void tighten(std::vector<PolylinePoint>& points, bool closed) const {
    const Polyline line(points, closed);
    const double reach = std::max(2.5 * spacing_, 0.3 * edge_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double curvature = line.turn(i, reach) / reach;
      const double chord = std::sqrt(8 * feature_deviation * edge_ / std::max(curvature, 1e-9 / edge_));
      points[i].relative_sizing *= std::clamp(edge_ / chord, 1.0, max_tightened);
    }
  }

  double edge_, spacing_;
  FeatureCurves features_;
  std::map<Index, Index> corner_of_;
};

}  // namespace

FeatureCurves find_feature_curves(const SampleSet& samples, double angle, double edge, ExecutionContext& context) {
  const FeatureGraph graph = find_feature_graph(samples, angle, context);
  if (graph.nodes.empty()) return {};
  const FeatureNetwork network = find_feature_network(graph, samples.grid.origin, samples.grid.spacing, edge);
  FeatureCurves all = Chains(edge, samples.grid.spacing).make(network);
  all.left_out = network.left_out;
  all = without_repeated(all, samples.grid.spacing);
  FeatureCurves features = without_crowded(all, graph.nodes, samples.grid.spacing, crowded_distance * edge);
  features.apexes = find_apexes(samples, graph.nodes, features, angle, edge, context);
  return features;
}

}  // namespace evenmesh
