#pragma once
/// Voronoi cells of seeds on a sampled surface: masses, centroids, energy, labels.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// What one evaluation of the energy gives. Masses in squared model units: w is a sample's weight, the area where all
/// is even.
struct CellSums {
  std::vector<double> mass;  ///< m_i, weight of cell i
  std::vector<Vec3> moment;  ///< Σ w (x − s_i) over cell i: the gradient of the energy is −2 · moment
  double energy = 0;         ///< F = Σ_i Σ_{x in cell i} w |x − s_i|²
};

/// The two nearest seeds of a sample and how far it lies from their bisector.
struct NearestPair {
  std::uint32_t first = 0, second = 0;  ///< second = first when there is one seed only
  float bisector_distance = 0;          ///< model units
};

/// Evaluates cells of changing seeds on one fixed set of samples.
///
/// A sample is not a point but a small disc of the surface, as large as its area and as heavy as its weight: it is cut
/// by the bisector of its two nearest seeds, and each part counts for its own seed. With that the energy is smooth in
/// the seeds, and agrees with its gradient wherever no third seed is as near (docs/cvt.md has the comparison with point
/// samples, boxes and clipped polygons).
///
/// Guarantee: same bits for any number of threads (sums are 64-bit integers). Cost: about 5 ns per sample and core;
/// memory O(seeds + blocks), and a few dozen KiB per thread.
/// The discrete form of [Raster2Mesh §4.2].
class CellEvaluator {
 public:
  CellEvaluator() = default;
  virtual ~CellEvaluator() = default;
  CellEvaluator(const CellEvaluator&) = delete;
  CellEvaluator& operator=(const CellEvaluator&) = delete;

  virtual const SampleSet& samples() const = 0;
  /// An evaluator of the same kind for other samples, to which it keeps a reference.
  virtual std::unique_ptr<CellEvaluator> for_samples(const SampleSet& samples, ExecutionContext& context) const = 0;

  virtual void evaluate(std::span<const Vec3> seeds, CellSums& sums) = 0;
  /// Nearest seed of every sample, ties to the lower index. Cost: about 2 ns per sample and core.
  virtual void nearest(std::span<const Vec3> seeds, std::vector<std::uint32_t>& labels) = 0;
  virtual void nearest_pairs(std::span<const Vec3> seeds, std::vector<NearestPair>& pairs) = 0;
};

class CpuCellEvaluator final : public CellEvaluator {
 public:
  /// Keeps a reference to `samples`.
  CpuCellEvaluator(const SampleSet& samples, ExecutionContext& context);
  ~CpuCellEvaluator() override;

  const SampleSet& samples() const override;
  std::unique_ptr<CellEvaluator> for_samples(const SampleSet& samples, ExecutionContext& context) const override;

  void evaluate(std::span<const Vec3> seeds, CellSums& sums) override;
  void nearest(std::span<const Vec3> seeds, std::vector<std::uint32_t>& labels) override;
  void nearest_pairs(std::span<const Vec3> seeds, std::vector<NearestPair>& pairs) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Makes evaluators that a device runs.
class CellKernel {
 public:
  virtual ~CellKernel() = default;
  /// Keeps a reference to `samples`. @return with the guarantees of CellEvaluator
  virtual std::unique_ptr<CellEvaluator> evaluator(const SampleSet& samples, ExecutionContext& context) const = 0;
};

/// Energy ratio F·k/A² / (5/(18√3)): 1 for a perfect hexagonal tiling of a plane, and, with the scale of
/// weigh_by_density(), for a perfect one of varying density.
/// @param area  the surface's true area
double energy_ratio(double energy, std::size_t seeds, double area);

}  // namespace evenmesh
