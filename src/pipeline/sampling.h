#pragma once
/// The surface as it was sampled: what seeds relax on, and what their cells are connected on.

#include <optional>
#include <vector>

#include "band/sheets.h"
#include "evenmesh/findings.h"
#include "evenmesh/mesh_shape.h"
#include "grid/sample_set.h"
#include "grid/sizing_field.h"
#include "pipeline/plan.h"
#include "pipeline/sampler.h"
#include "pipeline/stage_timer.h"

namespace evenmesh {

/// Of sheets: both sides of the shell, and which samples of it became the mesh's.
struct SheetSampling {
  BandSurface both_sides;
  Sheets sheets;
  std::vector<std::uint32_t> chosen;  ///< index of each of `samples` in both_sides.samples
  SampleSet on_surface;               ///< `samples`, drawn onto the surface in the middle of the shell
};

/// What may be missed of thin parts without a word: a few cells of the mesh, in squared edges.
inline constexpr double min_missed_area = 4;

struct Sampling {
  Plan plan;          ///< as it was carried out
  SampleSet samples;  ///< of the solid's surface, or of one side of every sheet
  std::optional<SheetSampling> sheet;
  SizingField sizing;
  std::size_t sampled = 0;                        ///< samples, before the topology was repaired
  std::size_t disagreements = 0, unresolved = 0;  ///< of those samples, see SampleSet
  /// Of solids: walls and gaps thinner than a cell, where they are as wide as a brick.
  std::vector<ThinSpot> thin;
  std::size_t filled_cavities = 0;
  double gap = 0;          ///< width of the gaps that edges cannot enter, model units; 0: nobody asked
  double hidden_area = 0;  ///< of the surface in such gaps that were filled
  std::size_t dropped_components = 0;
  std::size_t sites = 0, band_voxels = 0;  ///< of the shell
  std::size_t merges = 0;                  ///< gaps between sheets that hide surface
  unsigned thickness_apart = 0;            ///< voxels; the largest that keeps them apart
  std::vector<Finding> findings;           ///< those of the plan included

  bool closed() const { return !sheet; }
  /// Thin walls or gaps are missing on a tenth of the surface or more: what was sampled is what the grid happened to
  /// hit, and no number of seeds or balls makes it whole.
  bool unresolvable() const;
  /// Where vertices are placed.
  const SampleSet& surface() const { return sheet ? sheet->on_surface : samples; }
};

/// Cells along the longest side with which walls and gaps of that thickness are kept.
double resolution_for(double thickness, const Sampling& sampling);

/// Samples as planned; again on a finer or coarser grid where the surface turns out to be larger or smaller than the
/// plan expected, as on fractals, or where the density wants smaller cells.
/// @param kept  gets the crossings, or the shell, as far as asked for
/// @throws UnusableInput  nothing of the surface lies within the bounds, or all of it is too small
Sampling sample(const Sampler& sampler, Plan plan, const MeshOptions& options, StageTimer& timer,
                ExecutionContext& context, Artifacts& kept);

/// The two kinds: by rays, and by a shell of voxels (sheets and wraps).
Sampling sample_solid(const Sampler& sampler, Plan plan, const MeshOptions& options, StageTimer& timer,
                      ExecutionContext& context);
Sampling sample_band(const Sampler& sampler, Plan plan, const MeshOptions& options, StageTimer& timer,
                     ExecutionContext& context, Artifacts& kept);

/// Says of a mesh with one side only that the result cannot follow it.
void add_one_sided(const Sampler& sampler, Sampling& sampling, const ExecutionContext& context);
/// An edge cannot go where the outside is narrower. Where that hides much surface it is not worth its vertices: fills
/// such gaps in the samples, and says so. Little is left to the repair of the topology. Returns whether it did.
/// @param cure  what else keeps them, as ", or take …"
bool fill_narrow_gaps(Sampling& sampling, const std::string& cure, ExecutionContext& context);

/// How many more samples the smallest cells need than the mean ones; weighs the samples, and sets the sizing.
double apply_density(Sampling& sampling, const Density& density, ExecutionContext& context);

}  // namespace evenmesh
