#pragma once
/// The samples of every vertex' cell.

#include <cstdint>
#include <span>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "grid/sample_set.h"
#include "refine/vertex_rings.h"
#include "sample/projector.h"

namespace evenmesh {

/// Samples by the vertex nearest to them: some, or all where it matters. Keeps references to what it is made of.
class CellSamples {
 public:
  /// @param vertex_of_sample  vertex near each sample, none (0xffffffff) for those that are left out; where vertices
  /// have
  ///                          moved since, the nearest one is found from there along the edges
  /// @param projector  brings samples onto the surface within `error`; null: they lie on it
  CellSamples(const SampleSet& samples, std::span<const std::uint32_t> vertex_of_sample, const Mesh& mesh,
              const VertexRings& rings, const Projector* projector, double error, ExecutionContext& context);

  std::span<const Vec3> of(std::uint32_t v) const {
    if (list_[v] > 0) return lists_[list_[v] - 1];
    return {points_.data() + start_[v], start_[v + 1] - start_[v]};
  }
  /// From now on all samples of those vertices' cells. Cost: one pass over the labels.
  void take_all_of(std::span<const std::uint32_t> vertices);

 private:
  Vec3 position(std::size_t block, std::size_t i) const {
    return samples_.block_center(samples_.blocks[block]) + Vec3{samples_.x[i], samples_.y[i], samples_.z[i]};
  }
  /// The vertex nearest to p, by steps to a neighbour that is nearer.
  std::uint32_t nearest_vertex(const Vec3& p, std::uint32_t from) const;
  void correct(std::vector<Vec3>& points) const;

  const SampleSet& samples_;
  std::span<const std::uint32_t> vertex_of_sample_;
  const Mesh& mesh_;
  const VertexRings& rings_;
  const Projector* projector_;
  double error_;
  ExecutionContext& context_;
  std::vector<std::uint32_t> start_;
  std::vector<Vec3> points_;
  std::vector<std::uint32_t> list_;  ///< by vertex: 1 + index into lists_, 0 = some samples have to do
  std::vector<std::vector<Vec3>> lists_;
};

}  // namespace evenmesh
