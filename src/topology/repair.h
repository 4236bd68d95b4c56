#pragma once
/// What to do where cells do not fit together: more seeds, or, where the grid resolves no more, gaps filled.

#include <span>
#include <utility>
#include <vector>

#include "grid/sample_set.h"
#include "grid/seeds.h"
#include "topology/balls.h"

namespace evenmesh {

struct TopologyRepair {
  std::vector<Vec3> seeds;             ///< to be added
  std::vector<Ball> places;            ///< all places from now on: those given, some grown, and new ones
  std::vector<std::uint32_t> changed;  ///< indices of the places that are new or have grown
};

struct TopologyRepairOptions {
  double edge = 0;                                       ///< wanted edge length, model units
  double first_radius = 0, growth = 0, last_radius = 0;  ///< of places, model units
  std::size_t given = 0;  ///< labels from here on are those of pieces: their seeds are not there yet
  std::size_t seeds_per_cell = 1;
  bool prefer_places = false;  ///< wherever an ambiguous face is not far
  bool unresolved = false;     ///< the solid is so everywhere
  bool seeds_only = false;     ///< no more places: divide cells down to single samples
};

/// Seeds go to the samples farthest from the centre of each defective cell, and from each other. Where an ambiguous
/// face of the grid (find_ambiguous_faces) lies in them, or not far when cells have shrunk to a few samples, more seeds
/// cannot help: the topology there is an accident of the grid, and gaps are to be filled in a ball there. A defect that
/// meets such a place makes it grow. Departs from [Raster2Mesh §4.4], where the balls themselves are united with the
/// solid.
///
/// Cost: O(samples). Deterministic.
TopologyRepair plan_topology_repair(const SampleSet& samples, std::span<const std::uint32_t> labels,
                                    std::span<const Vec3> seeds,
                                    std::span<const std::pair<std::uint32_t, std::uint32_t>> defects,
                                    std::span<const Vec3> ambiguous_faces, const BallIndex& places,
                                    const TopologyRepairOptions& options);

/// Moves seeds out of balls, and leaves out those that lie closer than 0.6 edges to an earlier one around changed
/// balls.
void clear_around(std::vector<Vec3>& seeds, const BallIndex& balls, std::span<const std::uint32_t> changed,
                  double edge);

/// Removes up to `count` free seeds of cells that are not smaller than most, none next to another: their neighbours can
/// take the place over, while small cells are where the topology needs them. Removes fewer when there is no room for so
/// many. The size that counts is a cell's share in the vertices, its area where all is even.
/// @param labels  cells of the seeds; labels from seeds.size() on are those of pieces
void remove_common_cells(const SampleSet& samples, Seeds& seeds, std::span<const std::uint32_t> labels,
                         std::size_t count);

}  // namespace evenmesh
