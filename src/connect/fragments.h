#pragma once
/// Samples → triangles without any order among the samples: which seeds are about equally near to one of them.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "connect/label_complex.h"
#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

using SeedEdge = std::pair<std::uint32_t, std::uint32_t>;  ///< first < second

struct Fragments {
  /// Triangles of seeds, each once. `defects` are edges only: those of three triangles and more, and those of two that
  /// cannot be oriented alike; of a solid also those of fewer than two. No pieces.
  LabelComplex complex;
  std::vector<SeedEdge> delaunay;    ///< sorted: both seeds are the two nearest of some sample, up to ε equally near
  std::vector<SeedEdge> candidates;  ///< sorted: up to ε equally near, but never the two nearest
  std::size_t left_out = 0;          ///< triangles at crowded edges that are no part of the surface
};

struct FragmentOptions {
  std::size_t max_cycle = 5;  ///< of Delaunay edges, to be filled with triangles, [3, 8]
  bool open = false;          ///< the surface may have a boundary
  double margin = 0;  ///< ε, model units; 0: √3 grid spacings, how far a sample may be from any surface point
};

/// Connects seeds as the samples between them say. Nothing but the samples' positions and normals is looked at: neither
/// their order nor whether they bound a solid.
///
/// A sample that has its nearest seeds s1, s2 and s3 in up to ε the same distance makes (s1, s2) a Delaunay edge and
/// the other pairs candidates; one that has them in exactly the same distance says nothing. Triangles are the cycles of
/// three Delaunay edges. A cycle of four to `max_cycle` without chords comes from seeds on a common sphere when some
/// sample has all of them within ε of its nearest: it becomes a fan around the lowest seed that has an edge of either
/// kind to all others. Where an edge then has more than two triangles, those go whose three seeds no sample has as its
/// three nearest, then flaps: those with an edge of no other triangle. Orientation is that of the samples' normals at
/// most triangles of a part.
///
/// Guarantee: no triangle twice; same result for any number of threads. Whether every edge has two triangles depends on
/// the sampling: what is wrong is in `defects`. Vertices with several fans are not split. Cost: about 60 ns per sample
/// and core.
/// Based on [Raster2Mesh §4.3]; the inequality of x_edges is printed there the other way round, and seeds on a common
/// sphere are told by their distance from a sample instead of from each other, which would reject a square.
Fragments connect_fragments(const SampleSet& samples, std::span<const Vec3> seeds, const FragmentOptions& options,
                            ExecutionContext& context);

}  // namespace evenmesh
