#include "pipeline/lost_pieces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "geometry/places.h"
#include "geometry/triangle.h"
#include "geometry/union_find.h"

namespace evenmesh {
namespace {

std::vector<char> sampled_triangles(const SampleSet& samples, std::size_t triangles) {
  std::vector<char> sampled(triangles, 0);
  for (const std::uint32_t t : samples.source)
    if (t < triangles) sampled[t] = 1;
  return sampled;
}

/// A corner of every piece that is small and has no sample.
/// @param vertices  those at one place joined, or not
std::vector<Vec3> unsampled(const Mesh& mesh, UnionFind vertices, const std::vector<char>& sampled, const Box& bounds,
                            double max_area) {
  for (const Triangle& t : mesh.triangles) {
    vertices.unite(t[0], t[1]);
    vertices.unite(t[0], t[2]);
  }
  // By root; what has a sample is as good as infinite.
  std::vector<float> area(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    area[vertices.find(mesh.triangles[t][0])] +=
        sampled[t] ? std::numeric_limits<float>::infinity() : static_cast<float>(triangle_area(a, b, c));
  }
  std::vector<Vec3> places;
  for (std::size_t v = 0; v < area.size(); ++v)
    if (area[v] > 0 && area[v] < max_area && bounds.contains(mesh.vertices[v])) places.push_back(mesh.vertices[v]);
  return places;
}

/// How many of the places lie outside: along the x ray next to each, as many crossings enter the solid as leave it.
std::size_t count_outside(const std::vector<Vec3>& places, const SampleSet& samples) {
  const auto key = [](std::uint64_t j, std::uint64_t k) { return j << 32 | k; };
  std::unordered_multimap<std::uint64_t, std::size_t> of_ray;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3 at = (places[i] - samples.grid.origin) / samples.grid.spacing;
    if (at.y < 0 || at.z < 0) continue;
    of_ray.emplace(key(static_cast<std::uint64_t>(std::lround(at.y)), static_cast<std::uint64_t>(std::lround(at.z))),
                   i);
  }
  std::vector<int> entered(places.size(), 0);
  for (const SampleBlock& block : samples.blocks) {
    const double middle = samples.block_center(block).x;
    for (std::uint32_t s = block.begin; s < block.end_of_axis(0); ++s) {
      const EdgeCode edge = samples.edge[s];
      const auto [begin, end] =
          of_ray.equal_range(key(brick_size * block.brick[1] + edge.j(), brick_size * block.brick[2] + edge.k()));
      for (auto it = begin; it != end; ++it)
        if (middle + samples.x[s] < places[it->second].x) entered[it->second] += edge.lower_end_inside() ? -1 : 1;
    }
  }
  return static_cast<std::size_t>(std::count_if(entered.begin(), entered.end(), [](int n) { return n <= 0; }));
}

}  // namespace

std::size_t count_lost_pieces(const Mesh& mesh, const Box& bounds, const SampleSet& samples, double max_area) {
  const std::vector<char> sampled = sampled_triangles(samples, mesh.triangles.size());
  if (unsampled(mesh, UnionFind(mesh.vertices.size()), sampled, bounds, max_area).empty()) return 0;
  const std::vector<Vec3> places = unsampled(mesh, UnionFind(places_of(mesh.vertices)), sampled, bounds, max_area);
  return places.empty() ? 0 : count_outside(places, samples);
}

}  // namespace evenmesh
