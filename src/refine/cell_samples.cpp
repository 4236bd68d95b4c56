#include "refine/cell_samples.h"

#include <algorithm>
#include <utility>

#include "core/grouping.h"

namespace evenmesh {
namespace {

constexpr std::size_t samples_per_cell = 20;  ///< where some have to do
constexpr std::size_t piece = 1024;           ///< blocks of a task
constexpr std::size_t grain = 4096;           ///< samples of a task
constexpr int max_steps = 4;                  ///< from the vertex that was a sample's to the nearest

}  // namespace

CellSamples::CellSamples(const SampleSet& samples, std::span<const std::uint32_t> vertex_of_sample, const Mesh& mesh,
                         const VertexRings& rings, const Projector* projector, double error, ExecutionContext& context)
    : samples_(samples),
      vertex_of_sample_(vertex_of_sample),
      mesh_(mesh),
      rings_(rings),
      projector_(projector),
      error_(error),
      context_(context),
      list_(mesh.vertices.size(), 0) {
  const std::size_t vertices = mesh.vertices.size();
  // Every stride-th sample.
  const std::size_t stride =
      std::max<std::size_t>(1, samples.size() / (samples_per_cell * std::max<std::size_t>(1, vertices)));
  const auto each = [&](const auto& visit) {
    parallel_for(context, samples.blocks.size(), piece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b)
        for (std::size_t s = (samples.blocks[b].begin + stride - 1) / stride; s * stride < samples.blocks[b].end; ++s)
          visit(b, s);
    });
  };
  std::vector<std::uint32_t> of_sample((samples.size() + stride - 1) / stride, no_group);  // its vertex, then its place
  each([&](std::size_t b, std::size_t s) {
    if (const std::uint32_t v = vertex_of_sample[s * stride]; v < vertices)
      of_sample[s] = nearest_vertex(position(b, s * stride), v);
  });
  Groups groups = group_by_key(context, of_sample.size(), vertices, [&](std::size_t s) { return of_sample[s]; });
  parallel_for(context, groups.items.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) of_sample[groups.items[i]] = static_cast<std::uint32_t>(i);
  });
  start_ = std::move(groups.start);
  points_.resize(groups.items.size());
  each([&](std::size_t b, std::size_t s) {
    if (of_sample[s] != no_group) points_[of_sample[s]] = position(b, s * stride);
  });
  correct(points_);
}

void CellSamples::take_all_of(std::span<const std::uint32_t> vertices) {
  for (const std::uint32_t v : vertices) {
    list_[v] = static_cast<std::uint32_t>(lists_.size() + 1);
    lists_.emplace_back();
  }
  // Those that may have one of them for their nearest vertex.
  std::vector<char> asked(list_.size(), 0);
  for (const std::uint32_t v : vertices) {
    asked[v] = 1;
    for (const std::uint32_t w : rings_.neighbours(v)) asked[w] = 1;
  }
  std::vector<std::vector<std::pair<std::uint32_t, Vec3>>> found((samples_.blocks.size() + piece - 1) / piece);
  parallel_tasks(context_, found.size(), [&](std::size_t p) {
    for (std::size_t b = p * piece; b < std::min(samples_.blocks.size(), (p + 1) * piece); ++b)
      for (std::size_t i = samples_.blocks[b].begin; i < samples_.blocks[b].end; ++i)
        if (const std::uint32_t near = vertex_of_sample_[i]; near < asked.size() && asked[near]) {
          const Vec3 place = position(b, i);
          if (const std::uint32_t v = nearest_vertex(place, near); list_[v] > 0)
            found[p].push_back({list_[v] - 1, place});
        }
  });
  for (const auto& of_piece : found)
    for (const auto& [list, point] : of_piece) lists_[list].push_back(point);
  for (auto& list : lists_) correct(list);
}

std::uint32_t CellSamples::nearest_vertex(const Vec3& p, std::uint32_t from) const {
  double distance = squared_norm(p - mesh_.vertices[from]);
  for (int step = 0; step < max_steps; ++step) {
    const std::uint32_t at = from;
    for (const std::uint32_t w : rings_.neighbours(at))
      if (const double d = squared_norm(p - mesh_.vertices[w]); d < distance) {
        distance = d;
        from = w;
      }
    if (from == at) break;
  }
  return from;
}

void CellSamples::correct(std::vector<Vec3>& points) const {
  if (projector_ == nullptr) return;
  parallel_for(context_, points.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = projector_->project(points[i], error_);
  });
}

}  // namespace evenmesh
