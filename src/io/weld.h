#pragma once
/// One vertex for all corners with equal coordinates.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "evenmesh/mesh.h"
#include "io/source.h"

namespace evenmesh {

/// Numbers points in the order of their first appearance; −0 equals 0. Open addressing, linear probing.
class Welder {
 public:
  /// @param points  how many different ones to expect
  explicit Welder(std::size_t points) : slots_(std::bit_ceil(2 * points + 16), empty_slot) {
    vertices_.reserve(points);
  }

  static Vec3 canonical(const Vec3& p) { return {p.x + 0.0, p.y + 0.0, p.z + 0.0}; }  // −0 + 0 = +0
  static std::uint64_t hash(const Vec3& canonical_point) {
    const auto mix = [](std::uint64_t h) { return (h ^ (h >> 32)) * 0x9e3779b97f4a7c15ull; };
    std::uint64_t h = mix(std::bit_cast<std::uint64_t>(canonical_point.x));
    h = mix(h + std::bit_cast<std::uint64_t>(canonical_point.y));
    h = mix(h + std::bit_cast<std::uint64_t>(canonical_point.z));
    return h ^ (h >> 29);
  }
  /// Brings the slot into the cache for an insert() to come.
  void prefetch(std::uint64_t hash) const { __builtin_prefetch(&slots_[hash & (slots_.size() - 1)]); }

  std::uint32_t insert(const Vec3& canonical_point, std::uint64_t hash) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = hash & mask;; i = (i + 1) & mask) {
      const std::uint32_t slot = slots_[i];
      if (slot == empty_slot) {
        const auto index = static_cast<std::uint32_t>(vertices_.size());
        slots_[i] = index;
        vertices_.push_back(canonical_point);
        if (3 * vertices_.size() > 2 * slots_.size()) grow();
        return index;
      }
      if (vertices_[slot] == canonical_point) return slot;
    }
  }
  std::size_t size() const { return vertices_.size(); }
  std::vector<Vec3> take() { return std::move(vertices_); }

 private:
  static constexpr std::uint32_t empty_slot = 0xffffffff;

  void grow() {
    slots_.assign(2 * slots_.size(), empty_slot);
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      std::size_t i = hash(vertices_[v]) & mask;
      while (slots_[i] != empty_slot) i = (i + 1) & mask;
      slots_[i] = static_cast<std::uint32_t>(v);
    }
  }

  std::vector<std::uint32_t> slots_;
  std::vector<Vec3> vertices_;
};

/// Mesh of `triangles` loose triangles; corner(i) gives corner i % 3 of triangle i / 3, in any order.
/// Triangles with a coordinate that is not finite are left out; a finding tells how many.
/// Cost: O(triangles); hashes are computed a batch ahead, so that the table's cache misses overlap.
template <typename Corner>
Mesh weld(const Source& source, std::size_t triangles, const Corner& corner) {
  constexpr std::size_t batch = 16;
  static constexpr std::uint32_t left_out = 0xffffffff;
  Welder welder(triangles / 2 + 4);  // Euler: a closed surface has half as many vertices as triangles
  Mesh mesh;
  mesh.triangles.resize(triangles);
  std::array<Vec3, 3 * batch> points;
  std::array<std::uint64_t, 3 * batch> hashes;
  for (std::size_t first = 0; first < triangles; first += batch) {
    if (first % (batch << 12) == 0) source.context->throw_if_cancelled();
    if (welder.size() > max_vertices - 3 * batch) fail(source, "has more than 4,294,967,295 vertices; split it");
    const std::size_t corners = 3 * std::min(batch, triangles - first);
    for (std::size_t i = 0; i < corners; ++i) {
      points[i] = Welder::canonical(corner(3 * first + i));
      hashes[i] = Welder::hash(points[i]);
      welder.prefetch(hashes[i]);
    }
    for (std::size_t i = 0; i < corners; ++i) {
      // NaN equals nothing, so that all would pile up in one place.
      mesh.triangles[first + i / 3][i % 3] = is_finite(points[i]) ? welder.insert(points[i], hashes[i]) : left_out;
    }
  }
  mesh.vertices = welder.take();
  const std::size_t infinite = std::erase_if(
      mesh.triangles, [](const Triangle& t) { return std::find(t.begin(), t.end(), left_out) != t.end(); });
  remark_infinite(source, infinite, "triangle");
  return mesh;
}

}  // namespace evenmesh
