#pragma once
/// Cells → triangles: the dual of labelled grid quads, two-manifold by construction.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"
#include "grid/seeds.h"

namespace evenmesh {

/// Of samples that do not belong to the surface to be meshed: it ends there.
inline constexpr std::uint32_t no_label = 0xffffffffu;

/// A connected piece of a cell that is not the one which keeps the label.
struct CellComponent {
  std::uint32_t label = 0;      ///< the cell it comes from
  std::uint32_t new_label = 0;  ///< label it now has: a new one, or that of a neighbour when it is tiny
  double area = 0;
  Vec3 centroid;
};

/// The dual of a labelling.
struct LabelComplex {
  std::vector<Triangle> triangles;    ///< of labels, counter-clockwise from outside
  std::size_t labels = 0;             ///< labels in use, after splitting; new ones follow the given ones
  std::vector<CellComponent> pieces;  ///< pieces that became cells of their own, in order of new label
  std::int64_t surface_euler = 0;     ///< χ of the sampled surface; the mesh must have it (small components apart)
  /// Where seeds are needed, sorted: pairs of labels whose cells meet along several arcs; (l, l) for a cell that is not
  /// a disk or meets itself around a corner.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> defects;
  std::vector<std::size_t>
      edges_by_cycle{};  ///< of connect_fragments: edges from cycles of 3, 4, …; the shortest counts
};

/// Connects the cells of `labels` (one per sample, below `seeds.size()` or no_label; changed where cells are split).
///
/// Each crossing of a grid edge is one quad of the closed surface between inside and outside points; quads around a
/// grid cube's loop of crossings meet in a corner. Three or more labels around a corner make a dual polygon. A label
/// whose quads are not connected is split, and its largest piece keeps it, or the one nearest to the seed where that is
/// fixed; a piece smaller than a tenth of a mean cell, or of its own where that is below 0.3
/// mean cells, goes to a neighbour.
///
/// Guarantee: without defects the triangles are a closed, oriented two-manifold with the topology of the sampled solid.
/// Where samples have no label the surface has a boundary; several fans of triangles may then meet in one vertex there.
/// Same bits for any number of threads. Cost: about 60 ns per sample and core.
LabelComplex connect_labels(const SampleSet& samples, std::vector<std::uint32_t>& labels, const Seeds& seeds,
                            ExecutionContext& context);

/// The extraction of triangles, as a device can take it over.
class ExtractionKernel {
 public:
  virtual ~ExtractionKernel() = default;
  /// @return what connect_labels() gives, to the last bit
  virtual LabelComplex connect(const SampleSet& samples, std::vector<std::uint32_t>& labels, const Seeds& seeds,
                               ExecutionContext& context) const = 0;
};

}  // namespace evenmesh
