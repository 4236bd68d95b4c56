#include "refine/piercing.h"

#include <algorithm>
#include <vector>

#include "geometry/predicates.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

bool pierces(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (orient3d(a, b, c, p) * orient3d(a, b, c, q) >= 0) return false;
  const int ab = orient3d(p, q, a, b), bc = orient3d(p, q, b, c), ca = orient3d(p, q, c, a);
  return std::min({ab, bc, ca}) >= 0 || std::max({ab, bc, ca}) <= 0;
}

/// Whether an edge of s pierces t.
bool edge_pierces(const Mesh& mesh, const Triangle& s, const Triangle& t) {
  const auto is_corner = [&](std::uint32_t v) { return std::find(t.begin(), t.end(), v) != t.end(); };
  for (int c = 0; c < 3; ++c) {
    const std::uint32_t p = s[c], q = s[(c + 1) % 3];
    if (!is_corner(p) && !is_corner(q) &&
        pierces(mesh.vertices[p], mesh.vertices[q], mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]))
      return true;
  }
  return false;
}

Box box_of(const Mesh& mesh, std::size_t t) {
  Box box;
  for (const Vec3& corner : corners_of(mesh, t)) box.add(corner);
  return box;
}

bool are_apart(const Box& a, const Box& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (a.hi[axis] < b.lo[axis] || b.hi[axis] < a.lo[axis]) return true;
  return false;
}

}  // namespace

bool any_pierces(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
  std::vector<Box> boxes;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) boxes.push_back(box_of(mesh, t));
  for (const std::uint32_t s : triangles)
    for (std::size_t t = 0; t < boxes.size(); ++t)
      if (t != s && !are_apart(boxes[s], boxes[t]) &&
          (edge_pierces(mesh, mesh.triangles[s], mesh.triangles[t]) ||
           edge_pierces(mesh, mesh.triangles[t], mesh.triangles[s])))
        return true;
  return false;
}

}  // namespace evenmesh
