#pragma once
/// The state of tessellate(), and its steps.

#include <memory>

#include "cvt/relax.h"
#include "pipeline/tessellate.h"
#include "topology/repair.h"

namespace evenmesh {

/// A pair of labels whose cells do not fit together; twice the same for a cell alone.
using Defect = std::pair<std::uint32_t, std::uint32_t>;

class Tessellator {
 public:
  Tessellator(Sampling sampling, const MeshOptions& options, const Kernels& kernels, StageTimer& timer,
              ExecutionContext& context);

  /// Looks for sharp edges, where seeds are fixed so that the mesh gets an edge there.
  void find_features();
  /// Spreads `count` seeds from nothing. @param effort  of solids: scales the evaluations
  void relax_all(std::size_t count, double effort = 1);
  /// A few evaluations for the seeds as they are; of settled seeds, for those around what has changed since.
  /// @param effort  times as many
  void relax(std::size_t effort = 1);
  /// The same for the last seeds only, from index `first` on.
  void relax_last(std::size_t first);
  /// That many evaluations for the seeds within a few edges of the places. Cost: that of the surface there.
  void relax_around(std::span<const Vec3> places, std::size_t evaluations);
  /// These seeds are in balance, though of another energy: from now on only what changes is relaxed.
  void settle();
  /// Cells and their dual. Cells in several pieces are split: seeds for the others follow the given ones.
  void connect();
  /// Back to the seeds before connect(): it would split their cells again, and those of the pieces with them.
  void forget_split_cells();
  /// Drops components smaller than a cell, if some cell got no triangle, and goes on without them.
  bool clear_small_components();
  /// Adds or removes free seeds, by the weight of their cells.
  void adjust_count(std::size_t count, std::uint64_t salt);
  void adjust_and_relax(std::size_t count);
  /// Unites the changed balls with the solid, and clears seeds away from them.
  void unite_changed(std::span<const std::uint32_t> changed);
  /// Fills all gaps that edges cannot go into, where they hide much surface; whether they do. Cells are to be connected
  /// again then.
  bool fill_narrow_gaps();
  /// Fills narrow gaps there; cells are to be connected again.
  void fill_gaps(std::span<const Ball> places);
  /// Removes pieces of the surface that are smaller than a cell; whether there were any.
  bool drop_small_components();

  /// The surface around some points, with all seeds: those away from the points stay where they are, and cells that
  /// reach out of the part have no triangles. Null: it would be most of the surface.
  std::unique_ptr<Tessellator> part_around(std::span<const Vec3> points) const;
  /// The seeds of a part, those of split cells' pieces left out. Cells are to be connected again.
  void take_seeds(Tessellator& part);
  /// Free seeds more, which the topology needs.
  void insert(std::span<const Vec3> seeds);
  /// Gives up the feature curves whose seeds do not get along; the other seeds of these are free now.
  void release_features();

  /// Cells that own surface but no triangle.
  std::vector<std::uint32_t> unconnected() const;
  std::vector<Defect> defects() const;
  bool fits() const { return defects().empty(); }
  TopologyRepair plan_repair(std::span<const Vec3> ambiguous, TopologyRepairOptions options) const;

  bool closed() const { return result.sampling.closed(); }
  std::size_t wanted() const { return result.sampling.plan.vertices; }
  std::size_t fixed() const { return result.feature_seeds.size(); }
  /// Seeds that are not those of split cells' pieces.
  std::size_t given() const { return result.seeds.size() - result.complex.pieces.size(); }
  /// Mean length of the mesh's edges, as many cells as there are now; model units.
  double edge() const;

  Tessellation result;
  CellEvaluator& evaluator();
  const Kernels& kernels() const { return kernels_; }
  const MeshOptions& options;
  StageTimer& timer;
  ExecutionContext& context;

 private:
  void keep_long_features(double edge);
  LabelComplex dual_of(const SampleSet& samples, std::vector<std::uint32_t>& labels) const;
  void connect_solid();
  void connect_sheets();
  void connect_as_fragments();
  /// Of a part: cells with samples next to what was left out are not complete.
  void forget_incomplete_cells();
  bool is_frozen(std::size_t seed) const { return seed < frozen_.size() && frozen_[seed] != 0; }
  void refill_idle_seeds();
  std::vector<Vec3> unsettled() const;

  const Kernels& kernels_;
  std::unique_ptr<CellEvaluator> evaluator_;  ///< of the samples as they are; none yet after they changed
  std::vector<char> frozen_;                  ///< of a part, by seed
  std::vector<Vec3> settled_;                 ///< seeds in balance, sorted; none: relaxing them is left to the energy
};

/// Spreads the seeds as asked for by way of a mesh of a quarter, a sixteenth … as many vertices: its triangles are made
/// equilateral, its edges get a vertex in their middle, and what is left for the seeds' balance are the places where
/// that does not follow the shape. Irregular vertices remain those of the coarsest mesh, nearly.
/// @return false  where such a mesh cannot be had or strays too far from the shape: seeds are not changed
bool seed_by_levels(Tessellator& state);

/// Where the grid leaves the topology to chance in so many places that it does not resolve the solid, as of fractals
/// and of parts that nearly touch everywhere: fills gaps that edges cannot go into, if they hide much surface; seeds
/// are to be spread again then.
/// @return whether it did
bool fill_unresolved(Tessellator& state);
/// More seeds, and gaps filled where seeds cannot help (of solids that the grid does not resolve, balls united), around
/// the places where cells do not fit together: until they do, or the work of a dozen relaxations of the whole surface
/// is done. What is left then stays.
void repair_solid(Tessellator& state);
/// The paper's loop: the topology gives way, not the number of vertices. [Raster2Mesh §4.4]
void simplify_solid(Tessellator& state);
/// More seeds in cells that do not fit together. Sheets closer than the samples can tell stay together, however many.
void repair_sheets(Tessellator& state);

/// Where thin walls split cells in two there are more labels than seeds: starts again with fewer.
void meet_count(Tessellator& state);
/// Vertices too many or too few are corrected where the topology can do without them: among cells of common size.
void trim_count(Tessellator& state);

}  // namespace evenmesh
