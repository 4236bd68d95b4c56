// A part of the surface as a Tessellator of its own.
#include <algorithm>

#include "geometry/point_hash.h"
#include "grid/blocks.h"
#include "grid/morton.h"
#include "pipeline/tessellator.h"

namespace evenmesh {

std::unique_ptr<Tessellator> Tessellator::part_around(std::span<const Vec3> points) const {
  constexpr double free_within = 3, part_within = 5.5;  // edges: between them are two rings of cells that stay complete
  constexpr double most = 0.8;                          // of the samples
  const SampleSet& samples = result.sampling.samples;
  const SizingField& sizing = result.sampling.sizing;
  // Where edges shall be longer than the mean, the part reaches farther.
  double longest = edge();
  for (const Vec3& p : points) longest = std::max(longest, sizing.edge(p));
  const PointHash index(points, part_within * longest);
  const auto is_near = [&](const Vec3& p, double edges) {
    return index.near(p, edges * longest, [](std::uint32_t) { return true; });
  };
  std::vector<std::uint32_t> blocks;
  std::size_t size = 0;
  for (std::uint32_t b = 0; b < samples.blocks.size(); ++b) {
    const SampleBlock& block = samples.blocks[b];
    if (!is_near(samples.block_center(block), part_within)) continue;
    blocks.push_back(b);
    size += block.end - block.begin;
  }
  if (static_cast<double>(size) > most * static_cast<double>(samples.size())) return nullptr;
  Sampling sampling;
  sampling.plan = result.sampling.plan;
  sampling.sizing = sizing;
  sampling.samples = part_of(samples, blocks, context);
  auto part = std::make_unique<Tessellator>(std::move(sampling), options, kernels_, timer, context);
  part->result.features = result.features;
  part->result.feature_seeds = result.feature_seeds;
  part->result.seeds = result.seeds;
  part->result.seeds.positions.resize(given());
  part->result.filled = result.filled;
  part->result.balls = result.balls;
  for (const Vec3& seed : part->result.seeds.positions) part->frozen_.push_back(!is_near(seed, free_within));
  return part;
}

void Tessellator::relax_around(std::span<const Vec3> places, std::size_t evaluations) {
  constexpr double free_within = 2.5, part_within = 4.2, seeds_within = 6;  // edges
  if (places.empty()) return;
  timer.stage("relax", 0, [&] {
    const SampleSet& samples = result.sampling.samples;
    double longest = edge();
    for (const Vec3& p : places) longest = std::max(longest, result.sampling.sizing.edge(p));
    const PointHash index(places, free_within * longest);
    const auto is_near = [&](const Vec3& p, double edges) {
      return index.near(p, edges * longest, [](std::uint32_t) { return true; });
    };
    std::vector<std::uint32_t> blocks, members;
    for (std::uint32_t b = 0; b < samples.blocks.size(); ++b)
      if (is_near(samples.block_center(samples.blocks[b]), part_within)) blocks.push_back(b);
    SampleSet part = part_of(samples, blocks, context);
    Seeds seeds;
    std::vector<char> frozen;
    for (std::uint32_t s = 0; s < result.seeds.size(); ++s) {
      const Vec3& p = result.seeds.positions[s];
      if (!is_near(p, seeds_within)) continue;
      members.push_back(s);
      seeds.positions.push_back(p);
      if (result.seeds.is_fixed(s)) seeds.fixed.push_back(result.seeds.fixed[s]);
      frozen.push_back(!is_near(p, free_within));
    }
    // What a mean cell is does not change.
    const double share = static_cast<double>(members.size()) / static_cast<double>(result.seeds.size());
    part.total_area *= share;
    part.total_weight *= share;
    const auto cells =
        kernels_.cells ? kernels_.cells->evaluator(part, context) : std::make_unique<CpuCellEvaluator>(part, context);
    optimize(*cells, seeds, {options.optimizer == Optimizer::lloyd, evaluations, options.tolerance, frozen}, context);
    for (std::size_t i = 0; i < members.size(); ++i) result.seeds.positions[members[i]] = seeds.positions[i];
  });
}

namespace {

bool comes_before(const Vec3& p, const Vec3& q) {
  return std::array{p.x, p.y, p.z} < std::array{q.x, q.y, q.z};
}

}  // namespace

void Tessellator::settle() {
  settled_ = result.seeds.positions;
  std::sort(settled_.begin(), settled_.end(), comes_before);
}

/// Seeds that are new or moved since settle(), and places of those that were there then.
std::vector<Vec3> Tessellator::unsettled() const {
  std::vector<Vec3> now = result.seeds.positions, places;
  std::sort(now.begin(), now.end(), comes_before);
  std::set_symmetric_difference(now.begin(), now.end(), settled_.begin(), settled_.end(), std::back_inserter(places),
                                comes_before);
  return places;
}

void Tessellator::take_seeds(Tessellator& part) {
  part.forget_split_cells();
  result.seeds = part.result.seeds;
  result.complex.pieces.clear();
  result.inserted_seeds += part.result.inserted_seeds;
  part.result.inserted_seeds = 0;
}

void Tessellator::forget_incomplete_cells() {
  const SampleSet& samples = result.sampling.samples;
  const std::vector<std::uint64_t>& left_out = samples.left_out;
  if (left_out.empty()) return;
  std::vector<char> incomplete(result.seeds.size(), 0);
  for (const SampleBlock& block : samples.blocks) {
    bool at_border = false;
    for (int n = 0; n < 27 && !at_border; ++n) {
      const std::array<int, 3> at{block.brick[0] + n % 3 - 1, block.brick[1] + n / 3 % 3 - 1,
                                  block.brick[2] + n / 9 - 1};
      at_border = std::min({at[0], at[1], at[2]}) >= 0 &&
                  std::binary_search(left_out.begin(), left_out.end(),
                                     morton_code(static_cast<std::uint64_t>(at[0]), static_cast<std::uint64_t>(at[1]),
                                                 static_cast<std::uint64_t>(at[2])));
    }
    if (!at_border) continue;
    for (std::uint32_t i = block.begin; i < block.end; ++i) incomplete[result.labels[i]] = 1;
  }
  for (std::uint32_t& label : result.labels)
    if (incomplete[label]) label = no_label;
}

}  // namespace evenmesh
