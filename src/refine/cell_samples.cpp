#include "refine/cell_samples.h"

#include <algorithm>
#include <utility>

#include "core/grouping.h"

namespace evenmesh {
namespace {

constexpr std::size_t samples_per_cell = 20;  ///< where some have to do
constexpr std::size_t piece = 1024;           ///< blocks of a task

}  // namespace

CellSamples::CellSamples(const SampleSet& samples, std::span<const std::uint32_t> vertex_of_sample,
                         std::size_t vertices, const Projector* projector, double error, ExecutionContext& context)
    : samples_(samples),
      vertex_of_sample_(vertex_of_sample),
      projector_(projector),
      error_(error),
      context_(context),
      list_(vertices, 0) {
  // Every stride-th sample.
  const std::size_t stride =
      std::max<std::size_t>(1, samples.size() / (samples_per_cell * std::max<std::size_t>(1, vertices)));
  const std::size_t count = (samples.size() + stride - 1) / stride;
  std::vector<std::uint32_t> vertex(count, no_group);
  std::vector<Vec3> place(count);
  parallel_for(context, samples.blocks.size(), piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t s = (samples.blocks[b].begin + stride - 1) / stride; s * stride < samples.blocks[b].end; ++s)
        if (const std::uint32_t v = vertex_of_sample[s * stride]; v < vertices) {
          vertex[s] = v;
          place[s] = position(b, s * stride);
        }
  });
  Groups groups = group_by_key(context, count, vertices, [&](std::size_t s) { return vertex[s]; });
  start_ = std::move(groups.start);
  points_.resize(groups.items.size());
  parallel_for(context, points_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points_[i] = place[groups.items[i]];
  });
  correct(points_);
}

void CellSamples::take_all_of(std::span<const std::uint32_t> vertices) {
  for (const std::uint32_t v : vertices) {
    list_[v] = static_cast<std::uint32_t>(lists_.size() + 1);
    lists_.emplace_back();
  }
  std::vector<std::vector<std::pair<std::uint32_t, Vec3>>> found((samples_.blocks.size() + piece - 1) / piece);
  parallel_tasks(context_, found.size(), [&](std::size_t p) {
    for (std::size_t b = p * piece; b < std::min(samples_.blocks.size(), (p + 1) * piece); ++b)
      for (std::size_t i = samples_.blocks[b].begin; i < samples_.blocks[b].end; ++i)
        if (const std::uint32_t v = vertex_of_sample_[i]; v < list_.size() && list_[v] > 0)
          found[p].push_back({list_[v] - 1, position(b, i)});
  });
  for (const auto& of_piece : found)
    for (const auto& [list, point] : of_piece) lists_[list].push_back(point);
  for (auto& list : lists_) correct(list);
}

void CellSamples::correct(std::vector<Vec3>& points) const {
  if (projector_ == nullptr) return;
  parallel_for(context_, points.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = projector_->project(points[i], error_);
  });
}

}  // namespace evenmesh
