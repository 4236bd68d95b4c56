#pragma once
/// Sharp edges of a sampled surface: curves along them, and the corners where these begin, end, meet or turn.

#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// How far a sharp edge may lie from the chords that follow it, in edge lengths.
inline constexpr double feature_deviation = 0.08;

/// A sharp edge from one corner to another, or to itself.
struct FeatureCurve {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t from = none, to = none;  ///< corners; none: a closed curve, whose last point is its first
  std::vector<Vec3> points;              ///< two or more, about a grid cell apart; the corners are among them
  /// Up to each point: length, in units of the spacing that vertices are meant to have there (model units times a
  /// factor that is 1 where the density is uniform).
  std::vector<double> arc;
  double length() const { return arc.back(); }
};

struct FeatureCurves {
  std::vector<Vec3> corners;
  std::vector<FeatureCurve> curves;
  std::vector<Vec3> apexes;    ///< of cones and the like: points where the normal turns and no curve ends
  std::vector<Vec3> left_out;  ///< one place on each curve that was found, is no noise, and cannot be followed
};

/// Finds the edges across which the normal turns by more than `angle` degrees.
///
/// Two crossings of the surface with the edges of one face of the grid, neighbours along the surface, whose normals
/// differ by more than that have a feature curve between them; it goes on into the cubes on both sides of the face. So
/// feature curves are paths of cubes, found without any search in space. A cube's point of the feature curve is where
/// the tangent planes of its crossings meet (Ju et al., Dual contouring of Hermite data, 2002); three kinds of planes
/// make a corner.
///
/// Curves that fade are followed down to two thirds of the angle. Connected curves of less than three edges' length, or
/// more with loose ends, are left out; corners nearer than a fifth of it become one. Curves that run side by
/// side nearer than a third of it, as around thin plates, are left out too: no mesh of such edges follows both.
/// Where most of what turns by two thirds of the angle does not reach the angle, as on scans and organic shapes, a
/// sharp edge is one that along nine tenths of its length turns by the angle and is 20 edges and 5 % of the model long,
/// or turns by 1.75 times the angle and is 6 edges and 3 % long.
/// @param edge  mean edge length of the mesh to come, model units; the grid is a few times finer
/// Guarantee: same result for any number of threads. Cost: about 50 ns per sample and core.
FeatureCurves find_feature_curves(const SampleSet& samples, double angle, double edge, ExecutionContext& context);

}  // namespace evenmesh
