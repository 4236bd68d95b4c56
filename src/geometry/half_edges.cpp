#include "geometry/half_edges.h"

#include "geometry/corners.h"

namespace evenmesh {

HalfEdges::HalfEdges(std::span<const Triangle> triangles, std::size_t vertices, const ExecutionContext& context)
    : opposite_(3 * triangles.size(), none), outgoing_(vertices, none) {
  Groups corners = corners_by_vertex(triangles, vertices, context);
  start_ = std::move(corners.start);
  half_edges_from_ = std::move(corners.items);
  constexpr std::size_t grain = 1024;
  parallel_for(context, vertices, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) pair_half_edges_at(static_cast<std::uint32_t>(v), triangles);
  });
}

void HalfEdges::pair_half_edges_at(std::uint32_t v, std::span<const Triangle> triangles) {
  const auto target = [&](std::uint32_t h) { return triangles[h / 3][(h % 3 + 1) % 3]; };
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

std::uint32_t HalfEdges::umbrellas(std::size_t vertex) const {
  // Mostly one goes once around and meets them all.
  std::uint32_t seen = 0, h = outgoing_[vertex];
  while (h != none && seen < corners(vertex)) {
    ++seen;
    h = opposite_[previous(h)];
    if (h == outgoing_[vertex]) break;
  }
  if (seen > 0 && seen == corners(vertex) && h == outgoing_[vertex]) return 1;
  std::uint32_t count = 0;
  visit_umbrellas(vertex, [&](std::uint32_t, std::uint32_t umbrella) { count = umbrella + 1; });
  return count;
}

}  // namespace evenmesh
