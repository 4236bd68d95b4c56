#pragma once
/// Cells that grow from their seeds along the surface.

#include <cstdint>
#include <span>
#include <vector>

#include "connect/label_complex.h"

namespace evenmesh {

/// Gives every connected cell what its seed reaches along the surface, where so far the nearest seed in space counts.
///
/// What of a cell is not connected with the sample next to its seed goes to the seed that reaches it first: samples are
/// taken in the order of their distance from the seed. So sheets that come close keep cells of their own. Pieces of
/// surface that no seed reaches keep their labels, as do samples with no_label.
///
/// @param labels  of the nearest seed, one per sample, or no_label; corrected in place
/// Returns how many samples changed. Guarantee: same result for any number of threads. Cost: about 50 ns per sample and
/// core.
/// Based on [NBEDT §3.4].
std::size_t flood_labels(const SampleSet& samples, std::vector<std::uint32_t>& labels, std::span<const Vec3> seeds,
                         ExecutionContext& context);

}  // namespace evenmesh
