#pragma once
/// What a mesh is like: triangle quality, topology, self-intersections, distance to another mesh.

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// Quality and topology of a triangle mesh. Angles in degrees, lengths in model units.
struct MeshQuality {
  std::size_t vertices = 0;  ///< vertices used by a triangle
  std::size_t unused_vertices = 0;
  std::size_t faces = 0;
  double q_min = 0, q_avg = 0;          ///< Q(t) = 6·area / (√3 · half perimeter · longest edge), 1 = equilateral
  double theta_min = 0, theta_avg = 0;  ///< smallest, and mean of, the triangles' smallest angles
  double theta_max = 0;                 ///< largest angle
  double below_30_ratio = 0;            ///< share of triangles whose smallest angle is below 30°
  double irregular_ratio = 0;           ///< share of interior vertices whose valence is not 6
  std::size_t max_valence = 0;
  double edge_length_avg = 0, edge_length_cv = 0;  ///< mean, and standard deviation / mean
  double area = 0, volume = 0;                     ///< volume is signed: positive when oriented outward
  std::size_t boundary_edges = 0;                  ///< edges of one triangle
  std::size_t non_manifold_edges = 0;              ///< edges of three or more triangles
  std::size_t non_manifold_vertices =
      0;  ///< vertices whose triangles form several fans, or that lie on a non-manifold edge
  std::size_t inconsistent_edges = 0;  ///< edges whose two triangles are oriented against each other
  std::size_t degenerate_faces = 0;    ///< triangles with a repeated vertex or collinear corners (exact)
  std::size_t components = 0;          ///< connected over edges
  std::int64_t euler = 0;              ///< vertices − edges + faces
  Box bounds;
  bool closed() const { return boundary_edges == 0 && faces > 0; }
  bool two_manifold() const { return non_manifold_edges == 0 && non_manifold_vertices == 0; }
  bool oriented() const { return inconsistent_edges == 0; }
};

/// Cost: O(faces · log faces) at worst; 100,000 faces take some ten milliseconds.
MeshQuality measure_quality(const Mesh& mesh, ExecutionContext& context = ExecutionContext::silent());

/// A line per figure, `"key": value`, as one JSON object (keys of the command line's --json).
std::string quality_json(const MeshQuality& quality);

/// Histogram over equal bins of [lo, hi]; values outside fall into the first or last bin.
struct Histogram {
  double lo = 0, hi = 1;
  std::vector<std::size_t> counts;
};
Histogram histogram_of_angles(const Mesh& mesh, int bins);   ///< all angles, [0°, 180°]
Histogram histogram_of_quality(const Mesh& mesh, int bins);  ///< Q of every triangle, [0, 1]

/// Pairs of triangles that intersect where they share no vertex or edge; pairs sharing an edge count when they
/// are coplanar and folded onto each other, pairs sharing a vertex when they meet beyond it. The same three vertices
/// twice are a pair, whichever way round. Degenerate triangles are left out. Any mesh will do, two-manifold or not.
///
/// Guarantee: exact on the double coordinates given. Returns each pair once, smaller index first, sorted.
/// Cost: near-linear for meshes without many overlaps; 120,000 faces about 0.2 s on one core.
std::vector<std::pair<std::uint32_t, std::uint32_t>> self_intersections(
    const Mesh& mesh, ExecutionContext& context = ExecutionContext::silent());

/// Distances between two meshes, sampled: every vertex and `samples` points spread by area on each side.
struct MeshDistance {
  double a_to_b_max = 0, b_to_a_max = 0;  ///< one-sided Hausdorff, model units
  double a_to_b_rms = 0, b_to_a_rms = 0;  ///< root of the mean squared distance over the area samples
  double a_to_b_mean = 0, b_to_a_mean = 0;
  double normal_deviation_avg =
      0;  ///< mean angle in degrees between the normals at a's samples and their closest points on b
  double reference_diagonal = 0;  ///< bounding-box diagonal of b
  /// From the sharp edges of b, those that turn by more than 40°, to the nearest of a that turn by more than 20°:
  /// largest and mean distance, model units; infinite when a has none.
  double crease_max = 0, crease_avg = 0;
  double crease_length = 0;    ///< of the sharp edges of b, model units; 0: it has none
  double edge_length_avg = 0;  ///< mean edge length of a, model units
  double hausdorff() const { return std::max(a_to_b_max, b_to_a_max); }
};
struct CompareOptions {
  std::size_t samples = 500'000;  ///< area samples on each mesh, [1, 1e9]
};
/// Cost: O((samples + vertices) · log faces). @throws InvalidInput if a mesh has no triangle.
MeshDistance compare_meshes(const Mesh& a, const Mesh& b, const CompareOptions& options = {},
                            ExecutionContext& context = ExecutionContext::silent());

}  // namespace evenmesh
