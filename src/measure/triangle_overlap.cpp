#include "measure/triangle_overlap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "geometry/predicates.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

using Corners = std::array<Vec3, 3>;

/// Sign of the area of a, b, c, seen along `axis`.
int turn(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
  return orient2d(drop_axis(a, axis), drop_axis(b, axis), drop_axis(c, axis));
}

/// Whether p, collinear with a and b in the projection along `axis`, lies between them or on one of them.
bool between(const Vec3& p, const Vec3& a, const Vec3& b, int axis) {
  const Point2 q = drop_axis(p, axis), c = drop_axis(a, axis), d = drop_axis(b, axis);
  return std::min(c.x, d.x) <= q.x && q.x <= std::max(c.x, d.x) && std::min(c.y, d.y) <= q.y &&
         q.y <= std::max(c.y, d.y);
}

/// Whether the closed segments pq and ab meet in the projection along `axis`.
bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, int axis) {
  const int a_side = turn(p, q, a, axis), b_side = turn(p, q, b, axis);
  const int p_side = turn(a, b, p, axis), q_side = turn(a, b, q, axis);
  if (a_side * b_side < 0 && p_side * q_side < 0) return true;
  return (a_side == 0 && between(a, p, q, axis)) || (b_side == 0 && between(b, p, q, axis)) ||
         (p_side == 0 && between(p, a, b, axis)) || (q_side == 0 && between(q, a, b, axis));
}

bool all_of_one_side(int a, int b, int c) {
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// An axis along which a triangle (not degenerate) keeps an area.
int any_axis(const Corners& t) {
  for (int axis = 0; axis < 2; ++axis)
    if (turn(t[0], t[1], t[2], axis) != 0) return axis;
  return 2;
}

/// Whether the closed segment pq meets the closed triangle; p_side and q_side are the sides of its plane they lie on.
bool segment_meets(const Vec3& p, const Vec3& q, int p_side, int q_side, const Corners& t) {
  if (p_side * q_side > 0) return false;
  if (p_side == 0 && q_side == 0) {
    const int axis = any_axis(t);
    for (int k = 0; k < 3; ++k)
      if (segments_meet(p, q, t[k], t[(k + 1) % 3], axis)) return true;
    return all_of_one_side(turn(t[0], t[1], p, axis), turn(t[1], t[2], p, axis), turn(t[2], t[0], p, axis));
  }
  // The line through p and q meets the plane in one point: it is inside when no edge passes on the other side of the
  // line.
  return all_of_one_side(orient3d(p, q, t[0], t[1]), orient3d(p, q, t[1], t[2]), orient3d(p, q, t[2], t[0]));
}

std::array<int, 3> sides_of_plane(const Corners& plane, const Corners& points) {
  std::array<int, 3> sides;
  for (int k = 0; k < 3; ++k) sides[k] = orient3d(plane[0], plane[1], plane[2], points[k]);
  return sides;
}

bool strictly_one_side(const std::array<int, 3>& s) {
  return s[0] != 0 && s[0] == s[1] && s[1] == s[2];
}

/// Two triangles meet when an edge of one meets the other, coplanar ones included.
bool any_edge_meets(const Corners& s, const Corners& t) {
  const std::array<int, 3> t_sides = sides_of_plane(s, t);
  if (strictly_one_side(t_sides)) return false;
  const std::array<int, 3> s_sides = sides_of_plane(t, s);
  if (strictly_one_side(s_sides)) return false;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (segment_meets(s[k], s[next], s_sides[k], s_sides[next], t)) return true;
    if (segment_meets(t[k], t[next], t_sides[k], t_sides[next], s)) return true;
  }
  return false;
}

/// Whether an edge of s has all of t strictly beyond it, seen along `axis`; `area` is the sign of s's projected area.
bool edge_separates(const Corners& s, int area, const Corners& t, int axis) {
  for (int k = 0; k < 3; ++k) {
    const Vec3 &a = s[k], &b = s[(k + 1) % 3];
    if (turn(a, b, t[0], axis) == -area && turn(a, b, t[1], axis) == -area && turn(a, b, t[2], axis) == -area)
      return true;
  }
  return false;
}

bool disjoint_overlap(const Corners& s, const Corners& t, int axis) {
  // Neighbours on a smooth surface are apart in the projection: that spares the exact tests where all is nearly
  // coplanar.
  const int s_area = turn(s[0], s[1], s[2], axis), t_area = turn(t[0], t[1], t[2], axis);
  if (edge_separates(s, s_area, t, axis) || (t_area != 0 && edge_separates(t, t_area, s, axis))) return false;
  return any_edge_meets(s, t);
}

/// Whether the line through s[0] = t[0] and a, seen along `axis`, has b on one side and t[1], t[2] on the other, so
/// that the triangles s = (v, a, b) and t can only meet in v; `area` is the sign of v, a, b.
bool ray_separates(const Vec3& a, int area, const Corners& t, int axis) {
  const Vec3& v = t[0];
  bool touches = false;
  for (int k = 1; k < 3; ++k) {
    const int side = turn(v, a, t[k], axis);
    if (side == area) return false;
    if (side != 0) continue;
    if (touches) return false;  // t's projection is degenerate
    touches = true;
    // On the line: on the other side of v? The products of collinear vectors have one sign, so rounding cannot hurt.
    Vec3 along = a - v, to = t[k] - v;
    along[axis] = to[axis] = 0;
    if (!(dot(along, to) < 0)) return false;
  }
  return true;
}

/// Triangles that share their first corner.
bool overlap_beyond_vertex(const Corners& s, const Corners& t, int axis) {
  const int s_area = turn(s[0], s[1], s[2], axis), t_area = turn(t[0], t[1], t[2], axis);
  if (ray_separates(s[1], s_area, t, axis) || ray_separates(s[2], -s_area, t, axis)) return false;
  if (t_area != 0 && (ray_separates(t[1], t_area, s, axis) || ray_separates(t[2], -t_area, s, axis))) return false;

  const int s1 = orient3d(t[0], t[1], t[2], s[1]), s2 = orient3d(t[0], t[1], t[2], s[2]);
  if (s1 * s2 > 0) return false;
  const int t1 = orient3d(s[0], s[1], s[2], t[1]), t2 = orient3d(s[0], s[1], s[2], t[2]);
  if (t1 * t2 > 0) return false;
  return segment_meets(s[1], s[2], s1, s2, t) || segment_meets(t[1], t[2], t1, t2, s);
}

/// Triangles (p, q, r) and (p, q, w): folded onto each other?
bool folded(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& w, int axis) {
  return turn(p, q, r, axis) == turn(p, q, w, axis) && orient3d(p, q, r, w) == 0;
}

/// The corners of a triangle, beginning with corner k.
Corners rotated(const Corners& t, int k) {
  return {t[k], t[(k + 1) % 3], t[(k + 2) % 3]};
}

}  // namespace

std::vector<std::uint8_t> projection_axes(const Mesh& mesh, const ExecutionContext& context) {
  std::vector<std::uint8_t> axes(mesh.triangles.size(), 3);
  parallel_for(context, axes.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [a, b, c] = corners_of(mesh, i);
      const Vec3 n = area_normal(a, b, c);
      const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
      const int largest = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
      for (int k = 0; k < 3 && axes[i] == 3; ++k) {
        const int axis = (largest + k) % 3;
        if (turn(a, b, c, axis) != 0) axes[i] = static_cast<std::uint8_t>(axis);
      }
    }
  });
  return axes;
}

bool triangles_overlap(const Mesh& mesh, std::uint32_t s, std::uint32_t t, int axis) {
  const Triangle &a = mesh.triangles[s], &b = mesh.triangles[t];
  int shared = 0, in_a = 0, in_b = 0;  // where the last shared vertex is
  int other_a = 3, other_b = 3;        // what is left of 0 + 1 + 2 without the shared ones
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (a[i] == b[j]) {
        ++shared;
        in_a = i;
        in_b = j;
        other_a -= i;
        other_b -= j;
      }
  const Corners p = corners_of(mesh, s), q = corners_of(mesh, t);
  switch (shared) {
    case 0:
      return disjoint_overlap(p, q, axis);
    case 1:
      return overlap_beyond_vertex(rotated(p, in_a), rotated(q, in_b), axis);
    case 2:
      return folded(p[(other_a + 1) % 3], p[(other_a + 2) % 3], p[other_a], q[other_b], axis);
    default:
      return true;  // the same triangle twice
  }
}

}  // namespace evenmesh
