#pragma once
/// Meshes with faults, and meshes of cells, for the tests of refinement.

#include <gtest/gtest.h>

#include <set>

#include "connect/label_complex.h"
#include "core/random.h"
#include "cvt/relax.h"
#include "geometry/half_edges.h"
#include "geometry/primitives.h"
#include "refine/vertex_rings.h"
#include "sample/sample.h"

namespace evenmesh {

/// Vertices moved by a Gaussian of `amplitude`, then back onto the sphere around the origin.
inline Mesh perturbed_sphere(int levels, double amplitude, std::uint64_t seed) {
  Mesh mesh = make_icosphere(levels);
  Random random(seed);
  for (Vec3& v : mesh.vertices) {
    const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
    v = normalized(v + amplitude * Vec3{x, y, z});
  }
  return mesh;
}

inline std::size_t edge_count(const Mesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) edges.insert(std::minmax(t[c], t[(c + 1) % 3]));
  return edges.size();
}

inline void expect_closed_manifold(const Mesh& mesh) {
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  for (std::size_t h = 0; h < 3 * mesh.triangles.size(); ++h) ASSERT_NE(edges.opposite(h), HalfEdges::none);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) ASSERT_LE(edges.umbrellas(v), 1u);
  EXPECT_EQ(2 * edge_count(mesh), 3 * mesh.triangles.size()) << "no edge twice";
}

inline double volume_of(const Mesh& mesh) {
  double volume = 0;
  for (const Triangle& t : mesh.triangles)
    volume += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) / 6;
  return volume;
}

inline double worst_score(const Mesh& mesh) {
  double worst = 2;
  for (const Triangle& t : mesh.triangles)
    worst = std::min(worst, VertexRings::score(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  return worst;
}

/// An even mesh of a shape with every vertex at its cell's seed, and the vertex of each sample.
struct CellMesh {
  SampleSet samples;
  std::vector<std::uint32_t> labels;
  Mesh mesh;
};

inline CellMesh mesh_of_cells(const Shape& shape, std::size_t resolution, std::size_t count) {
  ExecutionContext context(2);
  CellMesh result{sample_shape(shape, make_grid(shape.bounds, resolution), context), {}, {}};
  CpuCellEvaluator evaluator(result.samples, context);
  result.mesh.vertices = relax_seeds(evaluator, count, {.evaluations = 40}, context).seeds.positions;
  evaluator.nearest(result.mesh.vertices, result.labels);
  const LabelComplex complex = connect_labels(result.samples, result.labels, result.mesh.vertices, context);
  for (const CellComponent& piece : complex.pieces) result.mesh.vertices.push_back(piece.centroid);
  result.mesh.triangles = complex.triangles;
  return result;
}

}  // namespace evenmesh
