#include <algorithm>
#include <cmath>
#include <numbers>

#include "evenmesh/measure.h"
#include "geometry/triangle.h"
#include "measure/triangle_quality.h"

namespace evenmesh {
namespace {

Histogram make_histogram(double lo, double hi, int bins) {
  if (bins < 1) throw InvalidInput("a histogram needs at least one bin");
  return {lo, hi, std::vector<std::size_t>(static_cast<std::size_t>(bins))};
}

void count(Histogram& histogram, double value) {
  const auto bins = static_cast<double>(histogram.counts.size());
  const double bin = std::floor((value - histogram.lo) / (histogram.hi - histogram.lo) * bins);
  ++histogram.counts[static_cast<std::size_t>(std::clamp(bin, 0.0, bins - 1))];
}

}  // namespace

Histogram histogram_of_angles(const Mesh& mesh, int bins) {
  Histogram histogram = make_histogram(0, 180, bins);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto corners = corners_of(mesh, t);
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = corners[(k + 1) % 3] - corners[k], v = corners[(k + 2) % 3] - corners[k];
      count(histogram, std::atan2(norm(cross(u, v)), dot(u, v)) * 180 / std::numbers::pi);
    }
  }
  return histogram;
}

Histogram histogram_of_quality(const Mesh& mesh, int bins) {
  Histogram histogram = make_histogram(0, 1, bins);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    count(histogram, triangle_quality(a, b, c).q);
  }
  return histogram;
}

}  // namespace evenmesh
