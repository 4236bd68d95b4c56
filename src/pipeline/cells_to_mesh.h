#pragma once
/// The loop between cells and triangles: connect, insert seeds where the topology needs them, until two-manifold.

#include "connect/label_complex.h"
#include "cvt/relax.h"
#include "evenmesh/mesh_shape.h"
#include "features/feature_seeds.h"
#include "pipeline/stage_timer.h"
#include "topology/balls.h"

namespace evenmesh {

struct ConnectedCells {
  std::vector<Vec3> seeds;            ///< one per label
  std::vector<std::uint32_t> labels;  ///< one per sample
  std::vector<Triangle> triangles;    ///< of labels
  bool two_manifold = false;
  std::vector<std::pair<std::uint32_t, Vec3>> anchors{};  ///< shell: cells at the rim, and their place on it
  FeatureCurves features{};
  FeatureSeeds feature_seeds{};  ///< the first seeds, which have not moved
  BallIndex balls{{}};           ///< united with the solid where the grid could not tell its topology
};

/// What the options mean for balancing seeds.
RelaxOptions relax_options(const MeshOptions& options);

/// Of connect_fragments: the shares of edges by the cycle that they come from, for the report and the log.
void report_cycles(const LabelComplex& complex, Report& report, ExecutionContext& context);

/// Balances about `count` seeds on `samples` (dust is removed from them) and connects their cells; the report gets
/// counts, energies and notices. The vertex count is met by starting with fewer seeds where thin walls split cells.
ConnectedCells relax_and_connect(SampleSet& samples, std::size_t count, const MeshOptions& options, StageTimer& timer,
                                 Report& report, ExecutionContext& context);

}  // namespace evenmesh
