#pragma once
/// From samples to cells that fit together: seeds relax, their cells are connected, the topology is repaired.

#include <cstdint>
#include <utility>
#include <vector>

#include "connect/label_complex.h"
#include "features/feature_seeds.h"
#include "pipeline/sampling.h"
#include "topology/balls.h"

namespace evenmesh {

struct Tessellation {
  Sampling sampling;                ///< small components may have gone, and the solid been changed where it did not fit
  FeatureCurves features;           ///< those that are followed
  FeatureSeeds feature_seeds;       ///< the fixed ones among the seeds, and which of them are neighbours
  Seeds seeds;                      ///< one per label
  bool seeds_are_vertices = false;  ///< seeds lie on the surface where vertices shall be; else cells tell that place
  std::vector<std::uint32_t> labels;  ///< one per sample
  LabelComplex complex;               ///< triangles of labels
  bool two_manifold = false;          ///< all cells fit together
  BallIndex balls{{}};                ///< united with the solid to make its topology simpler
  BallIndex filled{{}};               ///< places where narrow gaps of the solid were filled
  PointHash filled_points{1};         ///< of the grid, that are inside since
  std::vector<double> energies;       ///< energy ratio after every evaluation
  double energy_ratio = 0;            ///< of the seeds before the topology was repaired
  std::size_t released_curves = 0;    ///< sharp edges given up where they stood in the way of the topology
  std::size_t inserted_seeds = 0;     ///< added because the topology needed them
  std::size_t regularization_rounds = 0;

  /// Whether the solid may be another there than the shape.
  bool was_changed_at(const Vec3& p) const {
    return balls.covers(p) ||
           filled_points.near(p, 2 * sampling.samples.grid.spacing, [](std::uint32_t) { return true; });
  }
};

/// Spreads seeds and connects their cells: one loop for solids and sheets.
///
/// The vertex count of solids is met by starting with fewer seeds where thin walls split cells, and by adding or
/// removing common cells in the end. Seeds are added, and gaps filled, where cells do not fit together.
/// Guarantee: same bytes for any number of threads. Every loop is bounded; what does not fit together in the end is
/// left, with two_manifold false.
/// Based on [Raster2Mesh §4.2–4.4] and, for sheets, [NBEDT §3.3, 3.4]: there seeds relax on one side of the shell, and
/// cells are connected along its border.
Tessellation tessellate(Sampling sampling, const MeshOptions& options, const Kernels& kernels, StageTimer& timer,
                        ExecutionContext& context);

}  // namespace evenmesh
