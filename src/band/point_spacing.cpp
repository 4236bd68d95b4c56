#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "core/sums.h"
#include "evenmesh/points.h"
#include "geometry/point_tree.h"

namespace evenmesh {
namespace {

constexpr std::size_t spacing_neighbours = 6;   ///< as many as a vertex has in an even mesh
constexpr std::size_t max_questions = 1 << 17;  ///< the median of so many is exact to a fraction of a per cent
constexpr std::size_t max_neighbours = 64;

void require_finite(const std::vector<Vec3>& points) {
  if (std::all_of(points.begin(), points.end(), is_finite)) return;
  throw InvalidInput("a point of the cloud has a coordinate that is not finite; remove it");
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double spacing_in(const PointTree& tree, const ExecutionContext& context) {
  if (tree.size() < 2) return 0;
  const std::size_t neighbours = std::min(spacing_neighbours, tree.size() - 1);
  std::vector<double> farthest(std::min(tree.size(), max_questions));
  parallel_for(context, farthest.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::array<double, spacing_neighbours> nearest{};
    const std::span<double> distances = std::span(nearest).first(neighbours);
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest(tree.point(i * tree.size() / farthest.size()), distances);
      farthest[i] = distances.back();
    }
  });
  return median(farthest);
}

/// Mean distance of each point to its nearest neighbours.
std::vector<double> mean_distances(const std::vector<Vec3>& points, std::size_t neighbours,
                                   const ExecutionContext& context) {
  std::vector<double> means(points.size());
  const PointTree tree(points, context);
  if (tree.size() < 2) return means;
  neighbours = std::min(neighbours, tree.size() - 1);
  parallel_for(context, points.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::array<double, max_neighbours> nearest{};
    const std::span<double> distances = std::span(nearest).first(neighbours);
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest(points[i], distances);
      for (const double d : distances) means[i] += d / static_cast<double>(neighbours);
    }
  });
  return means;
}

double largest_allowed(const std::vector<double>& distances, double deviations, const ExecutionContext& context) {
  const auto count = static_cast<double>(distances.size());
  const double mean = ordered_sum(context, distances.size(), [&](std::size_t i) { return distances[i]; }) / count;
  const double variance = ordered_sum(
      context, distances.size(), [&](std::size_t i) { return (distances[i] - mean) * (distances[i] - mean) / count; });
  return (mean + deviations * std::sqrt(variance)) * (1 + 1e-12);  // where all are equal, rounding must not decide
}

}  // namespace

double point_spacing(const PointCloud& cloud, ExecutionContext& context) {
  require_finite(cloud.points);
  return with_threads(context, [&] { return spacing_in(PointTree(cloud.points, context), context); });
}

PointCloud remove_outliers(const PointCloud& cloud, const OutlierOptions& options, ExecutionContext& context) {
  if (options.neighbours < 1 || options.neighbours > max_neighbours)
    throw InvalidInput("the neighbours that outliers are measured by must lie in [1, 64]");
  if (!(options.deviations >= 0 && options.deviations <= 100))
    throw InvalidInput("the standard deviations that outliers are allowed must lie in [0, 100]");
  if (!cloud.normals.empty() && cloud.normals.size() != cloud.points.size())
    throw InvalidInput("the cloud has normals for some points only; give one for each, or none");
  require_finite(cloud.points);
  PointCloud kept;
  with_threads(context, [&] {
    const std::vector<double> distances = mean_distances(cloud.points, options.neighbours, context);
    const double limit = largest_allowed(distances, options.deviations, context);
    for (std::size_t i = 0; i < distances.size(); ++i) {
      if (distances[i] > limit) continue;
      kept.points.push_back(cloud.points[i]);
      if (!cloud.normals.empty()) kept.normals.push_back(cloud.normals[i]);
    }
  });
  return kept;
}

}  // namespace evenmesh
