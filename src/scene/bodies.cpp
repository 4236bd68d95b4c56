#include "scene/bodies.h"

#include <algorithm>
#include <array>
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

/// Which diagonal cuts the walls of an extrusion where it matters, as OpenSCAD 2021.01 has it.
struct Diagonals {
  bool backwards = false;  ///< turned counter-clockwise on the way up, or not at all: the other one of two equal ones
  bool longer_on_top = false;  ///< where one direction is scaled to nothing, the shorter ones would leave ears
};

/// Copies of an outline, one behind the other, and the walls between them.
class Layers {
 public:
  Layers(const Outline& outline, std::uint64_t count, bool ring, const Diagonals& diagonals = {})
      : outline_(outline), count_(count), ring_(ring), diagonals_(diagonals) {
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
      const bool top = !ring_ && layer + 2 == count_;
      std::uint32_t first = 0;
      for (const Contour& contour : outline_.contours) {
        const auto n = static_cast<std::uint32_t>(contour.size());
        const bool flip = (twice_area(contour) < 0) != diagonals_.backwards;
        for (std::uint32_t i = 0; i < n; ++i) {
          const std::uint32_t a = first + i, b = first + (i + 1) % n;
          add_quad(mesh, {here + a, here + b, there + b, there + a}, flip, top && diagonals_.longer_on_top);
        }
        first += n;
      }
    }
  }

  /// Cut along the shorter diagonal.
  /// @param flip  which one where both are equal but for rounding
  static void add_quad(Mesh& mesh, const std::array<std::uint32_t, 4>& q, bool flip, bool longer) {
    constexpr double equal = 1e-5;
    const auto& v = mesh.vertices;
    const double one = norm(v[q[0]] - v[q[2]]), other = norm(v[q[1]] - v[q[3]]);
    const bool tie = std::abs(one - other) <= equal / 2 * (one + other);
    if ((tie ? !flip : one < other) != longer) {
      mesh.triangles.push_back({q[0], q[1], q[2]});
      mesh.triangles.push_back({q[0], q[2], q[3]});
    } else {
      mesh.triangles.push_back({q[0], q[1], q[3]});
      mesh.triangles.push_back({q[1], q[2], q[3]});
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
  Diagonals diagonals_;
  std::uint32_t size_ = 0;
};

}  // namespace

double Roundness::fragments(double radius) const {
  if (fn > 0) return std::floor(std::max(fn, 3.0));
  return std::ceil(std::max(std::min(360 / fa, radius * 2 * std::numbers::pi / fs), 5.0));
}

namespace {

/// Length of the spiral r = a·φ from its centre.
double spiral_length(double a, double angle) {
  return a / 2 * (angle * std::sqrt(1 + angle * angle) + std::asinh(angle));
}

/// How far a point at `radius` goes in the plane, turned by `angle` (radians) and scaled on the way.
double way_around(double radius, double angle, double scale) {
  if (scale == 1) return radius * angle;
  const double end = scale > 1 ? angle * scale / (scale - 1) : angle / (1 - scale);
  return spiral_length(radius / end, end) - spiral_length(radius / end, end - angle);
}

}  // namespace

double slices_of(const LinearExtrusion& how, const Roundness& roundness, const Outline& outline) {
  const double twist = std::abs(how.twist);
  const bool even = how.scale.x == how.scale.y;
  if (twist == 0 && even) return 1;
  double radius = 0, larger = 0, shift = 0;
  for (const Contour& contour : outline.contours) {
    for (const Point2& p : contour) {
      radius = std::max(radius, std::hypot(p.x, p.y));
      larger = std::max(larger, std::hypot(p.x * how.scale.x, p.y * how.scale.y));
      shift = std::max(shift, std::hypot(p.x - p.x * how.scale.x, p.y - p.y * how.scale.y));
    }
  }
  if (twist == 0) {
    if (roundness.fn > 0) return std::max(std::floor(roundness.fn), 1.0);
    return std::max(std::ceil(std::hypot(shift, how.up.z) / roundness.fs), 1.0);
  }
  const double least = std::max(std::ceil(twist / 120), 1.0);
  if (!(radius > 0)) return least;
  if (roundness.fn > 0) return std::max(std::ceil(twist / 360 * roundness.fn), least);
  const double angle = twist * (std::numbers::pi / 180);
  const double way = even ? way_around(radius, angle, how.scale.x) : std::max(radius, larger) * angle;
  return std::max(std::min(std::ceil(twist / roundness.fa), std::ceil(std::hypot(way, how.up.z) / roundness.fs)),
                  least);
}

std::uint64_t triangles_of(const Outline& outline, const LinearExtrusion& how) {
  return 2 * outline.points() * (how.slices + 1);
}

std::uint64_t triangles_of(const Outline& outline, const Revolution& how) {
  return 2 * outline.points() * (how.fragments + 1);
}

Mesh extrude(const Outline& outline, const LinearExtrusion& how) {
  const Vec3 base = how.center ? -0.5 * how.up : Vec3{};
  const Diagonals diagonals{.backwards = how.twist <= 0, .longer_on_top = (how.scale.x == 0) != (how.scale.y == 0)};
  return Layers(outline, how.slices + 1, false, diagonals).build([&](const Point2& p, std::uint64_t layer) {
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
