#pragma once
/// For every block of samples, the seeds that can be nearest to one of them.

#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "cvt/cell_kernels.h"
#include "sample/sample_set.h"

namespace evenmesh {

std::vector<BlockBox> block_boxes(const SampleSet& samples, const Run& run);

/// Candidate lists, kept while seeds move little.
///
/// A list stays complete as long as no seed has moved by more than its margin, a few of its last steps: most
/// evaluations of an optimization pay nothing for the search.
class CandidateLists {
 public:
  CandidateLists(const SampleSet& samples, const Run& run);

  /// Makes the lists valid for `seeds`.
  void update(std::span<const Vec3> seeds, const Run& run);

  /// Seeds of block b in ascending order, never empty; `nearest_two` are guaranteed to be among them.
  std::span<const std::uint32_t> of_block(std::size_t b) const {
    return {lists_[b / chunk].data() + offsets_[b], counts_[b]};
  }
  const BlockBox& box(std::size_t b) const { return boxes_[b]; }

 private:
  static constexpr std::size_t chunk = 32;  ///< blocks, neighbours mostly, that are searched together
  const SampleSet& samples_;
  std::vector<BlockBox> boxes_;
  std::vector<std::vector<std::uint32_t>> lists_;
  std::vector<std::uint32_t> offsets_, counts_;
  std::vector<Vec3> seeds_at_build_, last_seeds_;
  std::vector<float> margins_;

  bool still_valid(std::span<const Vec3> seeds) const;
  void set_margins(std::span<const Vec3> seeds);
};

}  // namespace evenmesh
