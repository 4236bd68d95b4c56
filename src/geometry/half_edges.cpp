#include "geometry/half_edges.h"

namespace evenmesh {

HalfEdges::HalfEdges(std::span<const Triangle> triangles, std::size_t vertices)
    : opposite_(3 * triangles.size(), none),
      outgoing_(vertices, none),
      start_(vertices + 1, 0),
      half_edges_from_(3 * triangles.size()) {
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) ++start_[v + 1];
  for (std::size_t v = 0; v < vertices; ++v) start_[v + 1] += start_[v];
  std::vector<std::uint32_t> fill(start_.begin(), start_.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) half_edges_from_[fill[triangles[t][c]]++] = static_cast<std::uint32_t>(3 * t + c);

  const auto target = [&](std::uint32_t h) { return triangles[h / 3][(h % 3 + 1) % 3]; };
  for (std::size_t v = 0; v < vertices; ++v) {
    if (start_[v] < start_[v + 1]) outgoing_[v] = half_edges_from_[start_[v]];
    for (std::uint32_t at = start_[v]; at < start_[v + 1]; ++at) {
      const std::uint32_t h = half_edges_from_[at], w = target(h);
      if (w <= v) continue;  // each edge once, from its lower vertex
      std::uint32_t forward = 0, backward = 0, back = none;
      for (std::uint32_t other = start_[v]; other < start_[v + 1]; ++other)
        forward += target(half_edges_from_[other]) == w;
      for (std::uint32_t other = start_[w]; other < start_[w + 1]; ++other)
        if (target(half_edges_from_[other]) == v) {
          ++backward;
          back = half_edges_from_[other];
        }
      if (forward == 1 && backward == 1) {
        opposite_[h] = back;
        opposite_[back] = h;
      }
    }
  }
}

std::uint32_t HalfEdges::umbrellas(std::size_t vertex) const {
  std::uint32_t count = 0;
  visit_umbrellas(vertex, [&](std::uint32_t, std::uint32_t umbrella) { count = umbrella + 1; });
  return count;
}

}  // namespace evenmesh
