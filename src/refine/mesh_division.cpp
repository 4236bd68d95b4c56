#include "refine/mesh_division.h"

namespace evenmesh {
namespace {

constexpr std::uint32_t none = EditableMesh::none;
constexpr double least_cosine = 0.5;

template <typename Visit>
void visit_neighbours(const EditableMesh& mesh, std::uint32_t v, const Visit& visit) {
  if (!mesh.on_boundary(v)) mesh.around(v, [&](std::uint32_t h) { visit(mesh.target(h)); });
}

/// By vertex the start from which it is reached first.
std::vector<std::uint32_t> grow(const EditableMesh& mesh, std::size_t parts, Random& random) {
  std::vector<std::uint32_t> used, queue, start(mesh.vertex_slots(), none);
  for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v)
    if (mesh.vertex_in_use(v)) used.push_back(v);
  const auto reach = [&](std::uint32_t v, std::uint32_t part) {
    if (start[v] != none) return;
    start[v] = part;
    queue.push_back(v);
  };
  for (std::uint32_t p = 0; p < parts; ++p) reach(used[random.below(used.size())], p);
  for (std::size_t at = 0; at < queue.size(); ++at)
    visit_neighbours(mesh, queue[at], [&](std::uint32_t w) { reach(w, start[queue[at]]); });
  return start;
}

}  // namespace

std::vector<std::uint32_t> divide_mesh(const EditableMesh& mesh, std::size_t parts, Random& random) {
  const std::vector<std::uint32_t> start = grow(mesh, parts, random);
  std::vector<std::uint32_t> part(start.size(), none);
  for (std::uint32_t v = 0; v < start.size(); ++v) {
    if (start[v] == none || mesh.on_boundary(v)) continue;
    bool within = true;
    visit_neighbours(mesh, v, [&](std::uint32_t w) { within = within && start[w] == start[v]; });
    if (within && facing_of(mesh, v).least_cosine > least_cosine) part[v] = start[v];
  }
  return part;
}

}  // namespace evenmesh
