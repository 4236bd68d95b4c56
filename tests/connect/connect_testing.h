#pragma once
/// Labelled surfaces for the tests of connection.

#include <map>
#include <set>
#include <string>

#include "connect/label_complex.h"
#include "cvt/cvt_testing.h"
#include "geometry/half_edges.h"

namespace evenmesh {

inline SampleSet sampled_gallery(const std::string& name, std::size_t resolution) {
  ExecutionContext context(2);
  const Shape shape = gallery_shape(name);
  return sample_shape(shape, make_grid(shape.bounds, resolution), context);
}

inline std::vector<std::uint32_t> nearest_labels(const SampleSet& samples, const std::vector<Vec3>& seeds) {
  ExecutionContext context(2);
  CpuCellEvaluator evaluator(samples, context);
  std::vector<std::uint32_t> labels;
  evaluator.nearest(seeds, labels);
  return labels;
}

/// χ of a triangle list, used vertices only.
inline std::int64_t euler_of(const std::vector<Triangle>& triangles) {
  std::set<std::uint32_t> vertices;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : triangles)
    for (int c = 0; c < 3; ++c) {
      vertices.insert(t[c]);
      edges.insert(std::minmax(t[c], t[(c + 1) % 3]));
    }
  return static_cast<std::int64_t>(vertices.size()) - static_cast<std::int64_t>(edges.size()) +
         static_cast<std::int64_t>(triangles.size());
}

/// Closed, oriented, one fan at every vertex; found independently of the code under test.
inline bool is_closed_manifold(const std::vector<Triangle>& triangles, std::size_t vertices) {
  const HalfEdges edges(triangles, vertices);
  for (std::size_t h = 0; h < 3 * triangles.size(); ++h)
    if (edges.opposite(h) == HalfEdges::none) return false;
  for (std::size_t v = 0; v < vertices; ++v)
    if (edges.umbrellas(v) > 1) return false;
  return true;
}

/// Labels that own samples but no triangle: their cells have fewer than three corners.
inline std::size_t unconnected_labels(const std::vector<std::uint32_t>& labels, const LabelComplex& complex) {
  std::vector<char> used(complex.labels, 0);
  for (const Triangle& t : complex.triangles)
    for (const std::uint32_t l : t) used[l] = 1;
  std::set<std::uint32_t> without;
  for (const std::uint32_t l : labels)
    if (!used[l]) without.insert(l);
  return without.size();
}

}  // namespace evenmesh
