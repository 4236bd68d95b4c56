#pragma once
/// The triangles around every vertex, and how good they are.

#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// Triangles by vertex; follows the mesh's positions, not its connectivity.
class VertexRings {
 public:
  /// Same result for any number of threads. Cost: some 50 ns per triangle and core.
  explicit VertexRings(const Mesh& mesh, const ExecutionContext& context = ExecutionContext::silent());

  std::span<const std::uint32_t> triangles(std::uint32_t v) const {
    return {around_.data() + start_[v], start_[v + 1] - start_[v]};
  }
  /// The vertices that share an edge with v.
  std::span<const std::uint32_t> neighbours(std::uint32_t v) const {
    return {beside_.data() + beside_start_[v], beside_start_[v + 1] - beside_start_[v]};
  }
  bool on_boundary(std::uint32_t v) const { return neighbours(v).size() != triangles(v).size(); }
  /// Area-weighted mean of the triangles' normals, unit length.
  Vec3 normal(std::uint32_t v) const;
  /// Mean edge length of the triangles around v.
  double edge_length(std::uint32_t v) const;
  /// Unit normals of the triangles around v.
  void normals(std::uint32_t v, std::vector<Vec3>& list) const;
  /// Smallest score() of the triangles around v; below zero when one has turned by more than 70° from `normals_before`.
  /// Once it is known to be at most `least`, some number that is.
  double worst_score(std::uint32_t v, std::span<const Vec3> normals_before, double least = -1) const;

  /// How good a triangle is, from 0 to above 1: the smaller of Q / 0.7 and sin(smallest angle) / sin(38°). 1 is good
  /// enough.
  static double score(const Vec3& a, const Vec3& b, const Vec3& c);
  Vec3 normal_of(const Triangle& t) const {
    return normalized(cross(mesh_.vertices[t[1]] - mesh_.vertices[t[0]], mesh_.vertices[t[2]] - mesh_.vertices[t[0]]));
  }
  double score(const Triangle& t) const {
    return score(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
  }

 private:
  /// Puts the neighbours of v behind the list; returns how many.
  std::uint32_t append_neighbours(std::uint32_t v, std::vector<std::uint32_t>& list) const;

  const Mesh& mesh_;
  std::vector<std::uint32_t> start_, around_, beside_start_, beside_;
};

/// Triangles whose score is below `least`, ascending.
std::vector<std::uint32_t> triangles_below(const Mesh& mesh, double least,
                                           const ExecutionContext& context = ExecutionContext::silent());

/// Two directions that span the plane across `normal`.
struct TangentPlane {
  Vec3 u, v;
  explicit TangentPlane(const Vec3& normal)
      : u(normalized(cross(normal, std::abs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}))), v(cross(normal, u)) {}
  /// The step of length `length` in direction `eighth` · 45°.
  Vec3 step(int eighth, double length) const {
    const double angle = eighth * std::numbers::pi / 4;
    return (length * std::cos(angle)) * u + (length * std::sin(angle)) * v;
  }
};

}  // namespace evenmesh
