#include "geometry/mesh_bodies.h"

#include <algorithm>
#include <cmath>

#include "geometry/triangle.h"
#include "geometry/winding_number.h"

namespace evenmesh {
namespace {

constexpr std::size_t most_probes = 64;  ///< of a body
constexpr double inside = 0.25;          ///< winding number: also on the surface
constexpr std::size_t none = ~std::size_t{0};

bool contains(const Box& outer, const Box& inner) {
  return outer.contains(inner.lo) && outer.contains(inner.hi);
}

bool touch(const Box& a, const Box& b) {
  for (int i = 0; i < 3; ++i)
    if (a.hi[i] < b.lo[i] || b.hi[i] < a.lo[i]) return false;
  return true;
}

bool lies_within(const Mesh& mesh, const MeshBody& inner, const MeshBody& outer) {
  if (!contains(outer.box, inner.box) || std::abs(inner.volume) >= std::abs(outer.volume)) return false;
  std::vector<Triangle> around;
  for (const std::uint32_t t : outer.triangles) around.push_back(mesh.triangles[t]);
  const std::size_t step = (inner.triangles.size() + most_probes - 1) / most_probes;
  for (std::size_t i = 0; i < inner.triangles.size(); i += step) {
    const auto [a, b, c] = corners_of(mesh, inner.triangles[i]);
    if (std::abs(winding_number(mesh.vertices, around, (a + b + c) / 3)) < inside) return false;
  }
  return true;
}

}  // namespace

std::vector<MeshBody> bodies_of(const Mesh& mesh, const std::vector<std::uint32_t>& number) {
  std::vector<MeshBody> bodies;
  for (std::uint32_t t = 0; t < number.size(); ++t) {
    if (number[t] >= bodies.size()) bodies.resize(number[t] + 1);
    bodies[number[t]].triangles.push_back(t);
  }
  for (MeshBody& body : bodies) {
    for (const std::uint32_t t : body.triangles)
      for (const Vec3& p : corners_of(mesh, t)) body.box.add(p);
    const Vec3 middle = body.box.center();
    for (const std::uint32_t t : body.triangles) {
      const auto [a, b, c] = corners_of(mesh, t);
      body.volume += dot(a - middle, cross(b - middle, c - middle)) / 6;
    }
  }
  return bodies;
}

std::vector<std::size_t> inverted_bodies(const Mesh& mesh, const std::vector<MeshBody>& bodies) {
  const auto faces = [&](int sign) {
    return std::any_of(bodies.begin(), bodies.end(), [&](const MeshBody& b) { return sign * b.volume > 0; });
  };
  if (!faces(1) || !faces(-1)) return {};
  std::vector<std::size_t> parent(bodies.size(), none), inverted;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = 0; j < bodies.size(); ++j)
      if (i != j && (parent[i] == none || std::abs(bodies[j].volume) < std::abs(bodies[parent[i]].volume)) &&
          lies_within(mesh, bodies[i], bodies[j]))
        parent[i] = j;
  const auto is_turned = [&](std::size_t i) {
    while (parent[i] != none) i = parent[i];
    if (!(bodies[i].volume < 0)) return false;
    for (std::size_t j = 0; j < bodies.size(); ++j)
      if (parent[j] == none && bodies[j].volume > 0 && touch(bodies[i].box, bodies[j].box)) return true;
    return false;
  };
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (is_turned(i)) inverted.push_back(i);
  return inverted;
}

}  // namespace evenmesh
