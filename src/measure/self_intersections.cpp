#include <algorithm>

#include "core/parallel.h"
#include "evenmesh/measure.h"
#include "geometry/triangle.h"
#include "measure/box_pairs.h"
#include "measure/triangle_overlap.h"

namespace evenmesh {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

/// Boxes of the triangles, empty for degenerate ones.
std::vector<Box> boxes_of(const Mesh& mesh, const std::vector<std::uint8_t>& axes, const ExecutionContext& context) {
  std::vector<Box> boxes(mesh.triangles.size());
  parallel_for(context, boxes.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      if (axes[t] < 3)
        for (const Vec3& corner : corners_of(mesh, t)) boxes[t].add(corner);
  });
  return boxes;
}

std::vector<Pair> find_pairs(const Mesh& mesh, const ExecutionContext& context) {
  const std::vector<std::uint8_t> axes = projection_axes(mesh, context);
  const BoxPairs candidates(boxes_of(mesh, axes, context), context);
  constexpr std::size_t groups_per_task = 64;
  std::vector<std::vector<Pair>> found((candidates.groups() + groups_per_task - 1) / groups_per_task);
  parallel_tasks(context, found.size(), [&](std::size_t task) {
    const std::size_t end = std::min((task + 1) * groups_per_task, candidates.groups());
    for (std::size_t group = task * groups_per_task; group < end; ++group)
      candidates.pairs_of_group(group, [&](std::uint32_t s, std::uint32_t t) {
        if (triangles_overlap(mesh, s, t, axes[s])) found[task].push_back(std::minmax(s, t));
      });
  });
  std::vector<Pair> pairs;
  for (const std::vector<Pair>& some : found) pairs.insert(pairs.end(), some.begin(), some.end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

std::vector<Pair> self_intersections(const Mesh& mesh, ExecutionContext& context) {
  if (mesh.triangles.empty()) return {};
  return with_threads(context, [&] { return find_pairs(mesh, context); });
}

}  // namespace evenmesh
