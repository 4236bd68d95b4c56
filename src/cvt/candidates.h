#pragma once
/// For every block of samples, the seeds that can be nearest to one of them.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "cvt/cell_kernels.h"
#include "grid/sample_set.h"

namespace evenmesh {

std::vector<BlockBox> block_boxes(const SampleSet& samples, const ExecutionContext& context);

class ChunkSeeds;
class SeedGrid;

/// Candidate lists, kept while seeds move little.
///
/// A list stays complete as long as no seed near it has moved by more than its margin, a few of its last steps. Most
/// evaluations of an optimization search again around the few seeds that did, or not at all.
class CandidateLists {
 public:
  CandidateLists(const SampleSet& samples, const ExecutionContext& context);

  /// Makes the lists valid for `seeds`.
  void update(std::span<const Vec3> seeds, const ExecutionContext& context);

  /// Seeds of block b in ascending order, never empty; `nearest_two` are guaranteed to be among them.
  std::span<const std::uint32_t> of_block(std::size_t b) const {
    return {chunks_[b / chunk].list.data() + offsets_[b], counts_[b]};
  }
  const BlockBox& box(std::size_t b) const { return boxes_[b]; }

 private:
  static constexpr std::size_t chunk = 32;  ///< blocks, neighbours mostly, that are searched together
  struct Chunk {
    std::vector<std::uint32_t> list;  ///< of one block after the other
    Box region;                       ///< seeds elsewhere do not matter to any of its blocks
  };
  const SampleSet& samples_;
  std::vector<BlockBox> boxes_;
  std::vector<Chunk> chunks_;
  std::vector<float> reach_;  ///< by block: seeds farther than this from its centre do not matter
  std::vector<std::uint32_t> offsets_, counts_;
  std::vector<Vec3> seeds_at_build_, last_seeds_;
  std::vector<float> margins_;
  float largest_margin_ = 0;

  bool is_valid_for(std::size_t seed, const Vec3& at) const;
  float margin(std::size_t seed, const Vec3& at, double spacing) const;
  /// Those that have left their margin, ascending.
  std::vector<std::uint32_t> strayed_seeds(std::span<const Vec3> seeds, const ExecutionContext& context) const;
  void build_all(std::span<const Vec3> seeds, double spacing, const ExecutionContext& context);
  void build_around(std::span<const std::uint32_t> strayed, std::span<const Vec3> seeds, double spacing,
                    const ExecutionContext& context);
  void build_chunk(std::size_t c, const std::array<bool, chunk>& stale, ChunkSeeds& near, double spacing);
  ChunkSeeds seeds_near(const SeedGrid& grid) const;
  std::size_t end_of_chunk(std::size_t c) const { return std::min((c + 1) * chunk, boxes_.size()); }
  Vec3 center(std::size_t b) const {
    const BlockBox& box = boxes_[b];
    return samples_.block_center(samples_.blocks[b]) + Vec3{box.center[0], box.center[1], box.center[2]};
  }
};

}  // namespace evenmesh
