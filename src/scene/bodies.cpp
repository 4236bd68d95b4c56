#include "scene/bodies.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "io/weld.h"

namespace evenmesh {
namespace {

/// Cosine and sine of degrees, exact at the axes.
Point2 direction_of(double degrees) {
  const double turn = std::fmod(degrees, 360);
  if (turn == 0) return {1, 0};
  if (turn == 90 || turn == -270) return {0, 1};
  if (turn == 180 || turn == -180) return {-1, 0};
  if (turn == 270 || turn == -90) return {0, -1};
  const double radians = turn * (std::numbers::pi / 180);
  return {std::cos(radians), std::sin(radians)};
}

double volume_of(const Mesh& mesh) {
  double six = 0;
  const Vec3 origin = mesh.vertices.empty() ? Vec3{} : mesh.vertices.front();
  for (const Triangle& t : mesh.triangles) {
    six += dot(mesh.vertices[t[0]] - origin, cross(mesh.vertices[t[1]] - origin, mesh.vertices[t[2]] - origin));
  }
  return six / 6;
}

/// One vertex where several are equal (poles, tips), no triangles without area for that reason, outside out.
Mesh tidied(const Mesh& mesh) {
  Welder welder(mesh.vertices.size());
  std::vector<std::uint32_t> number;
  number.reserve(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) {
    const Vec3 p = Welder::canonical(v);
    number.push_back(welder.insert(p, Welder::hash(p)));
  }
  Mesh tidy;
  tidy.vertices = welder.take();
  for (const Triangle& t : mesh.triangles) {
    const Triangle renumbered{number[t[0]], number[t[1]], number[t[2]]};
    if (renumbered[0] == renumbered[1] || renumbered[1] == renumbered[2] || renumbered[2] == renumbered[0]) continue;
    tidy.triangles.push_back(renumbered);
  }
  if (volume_of(tidy) < 0)
    for (Triangle& t : tidy.triangles) std::swap(t[1], t[2]);
  return tidy;
}

/// Copies of an outline, one behind the other, and the walls between them.
class Layers {
 public:
  Layers(const Outline& outline, std::uint64_t count, bool ring) : outline_(outline), count_(count), ring_(ring) {
    size_ = static_cast<std::uint32_t>(outline.points());
  }

  /// @param place  where a point of the outline is in a layer
  template <typename Place>
  Mesh build(const Place& place) {
    Mesh mesh;
    mesh.vertices.reserve(size_ * count_);
    for (std::uint64_t layer = 0; layer < count_; ++layer)
      for (const Contour& contour : outline_.contours)
        for (const Point2& p : contour) mesh.vertices.push_back(place(p, layer));
    add_walls(mesh);
    if (!ring_) add_caps(mesh);
    return tidied(mesh);
  }

 private:
  void add_walls(Mesh& mesh) const {
    for (std::uint64_t layer = 0; layer + (ring_ ? 0 : 1) < count_; ++layer) {
      const auto here = static_cast<std::uint32_t>(layer * size_);
      const auto there = static_cast<std::uint32_t>((layer + 1) % count_ * size_);
      std::uint32_t first = 0;
      for (const Contour& contour : outline_.contours) {
        const auto n = static_cast<std::uint32_t>(contour.size());
        for (std::uint32_t i = 0; i < n; ++i) {
          add_quad(mesh, here + first + i, here + first + (i + 1) % n, there + first + (i + 1) % n, there + first + i);
        }
        first += n;
      }
    }
  }

  /// Cut along the shorter diagonal.
  static void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const auto& v = mesh.vertices;
    if (squared_norm(v[b] - v[d]) < squared_norm(v[a] - v[c])) {
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({b, c, d});
    } else {
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }

  void add_caps(Mesh& mesh) const {
    const auto last = static_cast<std::uint32_t>((count_ - 1) * size_);
    for (const Triangle& t : fill(outline_)) {
      mesh.triangles.push_back({t[0], t[2], t[1]});
      mesh.triangles.push_back({last + t[0], last + t[1], last + t[2]});
    }
  }

  const Outline& outline_;
  std::uint64_t count_;
  bool ring_;
  std::uint32_t size_ = 0;
};

}  // namespace

double Roundness::fragments(double radius) const {
  if (fn > 0) return std::floor(std::max(fn, 3.0));
  return std::ceil(std::max(std::min(360 / fa, radius * 2 * std::numbers::pi / fs), 5.0));
}

std::uint64_t triangles_of(const Outline& outline, const LinearExtrusion& how) {
  return 2 * outline.points() * (how.slices + 1);
}

std::uint64_t triangles_of(const Outline& outline, const Revolution& how) {
  return 2 * outline.points() * (how.fragments + 1);
}

Mesh extrude(const Outline& outline, const LinearExtrusion& how) {
  const Vec3 base = how.center ? -0.5 * how.up : Vec3{};
  return Layers(outline, how.slices + 1, false).build([&](const Point2& p, std::uint64_t layer) {
    const double t = static_cast<double>(layer) / static_cast<double>(how.slices);
    const Point2 turn = direction_of(-how.twist * t);
    const double sx = 1 + (how.scale.x - 1) * t, sy = 1 + (how.scale.y - 1) * t;
    return base + t * how.up + Vec3{sx * (turn.x * p.x - turn.y * p.y), sy * (turn.y * p.x + turn.x * p.y), 0};
  });
}

Mesh revolve(const Outline& outline, const Revolution& how) {
  const bool ring = std::abs(how.angle) >= 360;
  return Layers(outline, how.fragments + (ring ? 0 : 1), ring).build([&](const Point2& p, std::uint64_t layer) {
    const double step = how.angle * static_cast<double>(layer) / static_cast<double>(how.fragments);
    const Point2 turn = direction_of(how.start + step);
    return Vec3{p.x * turn.x, p.x * turn.y, p.y};
  });
}

Mesh polyhedron(std::vector<Vec3> points, const std::vector<std::vector<std::uint32_t>>& faces) {
  Mesh mesh;
  mesh.vertices = std::move(points);
  for (const std::vector<std::uint32_t>& face : faces) {
    if (face.size() < 3) continue;
    Vec3 normal;  // of the face as OpenSCAD sees it: inward
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      const Vec3& origin = mesh.vertices[face[0]];
      normal += cross(mesh.vertices[face[i]] - origin, mesh.vertices[face[i + 1]] - origin);
    }
    const Vec3 size{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    Outline flat;
    flat.contours.resize(1);
    for (const std::uint32_t v : face) flat.contours[0].push_back(drop_axis(mesh.vertices[v], axis));
    const bool mirrored = twice_area(flat.contours[0]) < 0;
    if (mirrored)
      for (Point2& p : flat.contours[0]) p.x = -p.x;
    for (const Triangle& t : fill(flat)) mesh.triangles.push_back({face[t[0]], face[t[2]], face[t[1]]});
  }
  return tidied(mesh);
}

Outline circle_outline(double radius, std::uint64_t fragments) {
  Contour contour;
  for (std::uint64_t i = 0; i < fragments; ++i) {
    const Point2 turn = direction_of(360.0 * static_cast<double>(i) / static_cast<double>(fragments));
    contour.push_back({radius * turn.x, radius * turn.y});
  }
  return {{std::move(contour)}};
}

Outline rectangle_outline(double width, double depth, bool center) {
  const double x = center ? -width / 2 : 0, y = center ? -depth / 2 : 0;
  return {{{{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}}}};
}

Outline half_ball_outline(double radius, std::uint64_t fragments) {
  const std::uint64_t rings = (fragments + 1) / 2;
  Contour contour;
  for (std::uint64_t i = 0; i < rings; ++i) {  // from the south pole up
    const Point2 turn = direction_of(-90 + 180 * (static_cast<double>(i) + 0.5) / static_cast<double>(rings));
    if (i == 0) contour.push_back({0, radius * turn.y});
    contour.push_back({radius * turn.x, radius * turn.y});
    if (i + 1 == rings) contour.push_back({0, radius * turn.y});
  }
  return {{std::move(contour)}};
}

}  // namespace evenmesh
