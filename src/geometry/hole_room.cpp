#include "geometry/hole_room.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/triangle.h"

namespace evenmesh {
namespace {

constexpr int directions = 32;
constexpr double farthest = 4;  ///< radii of the hole

/// How far a ray goes, model units.
double distance_along(const EmbreeScene& scene, const Vec3& from, const Vec3& direction, double most) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  const Vec3 origin = scene.to_local(from);
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(origin.x);
  ray.ray.org_y = static_cast<float>(origin.y);
  ray.ray.org_z = static_cast<float>(origin.z);
  ray.ray.dir_x = static_cast<float>(direction.x);
  ray.ray.dir_y = static_cast<float>(direction.y);
  ray.ray.dir_z = static_cast<float>(direction.z);
  ray.ray.tfar = static_cast<float>(most * scene.scale());
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene.handle(), &context, &ray);
  return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? most : static_cast<double>(ray.ray.tfar) / scene.scale();
}

}  // namespace

double room_behind(const EmbreeScene& scene, const std::vector<Vec3>& vertices, std::span<const Triangle> fill,
                   double outward) {
  Vec3 normal, middle;
  double area = 0;
  for (const Triangle& t : fill) {
    const Vec3 &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
    const double part = triangle_area(a, b, c);
    normal += 0.5 * area_normal(a, b, c);
    middle += (part / 3) * (a + b + c);
    area += part;
  }
  const double across = norm(normal);
  if (!(area > 0) || !(across > 0)) return 0;
  middle = middle / area;
  const Vec3 down = (-outward / across) * normal;
  const double radius = std::sqrt(area / std::numbers::pi);
  const Vec3 at = middle + 0.5 * std::min(distance_along(scene, middle, down, 2 * radius), 2 * radius) * down;
  const Vec3 other = std::abs(down.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(down, other)), v = cross(down, u);
  double room = 0;
  for (int i = 0; i < directions; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / directions;
    const double reach = distance_along(scene, at, std::cos(angle) * u + std::sin(angle) * v, farthest * radius);
    room += std::numbers::pi / directions * reach * reach;
  }
  return room / across;
}

}  // namespace evenmesh
