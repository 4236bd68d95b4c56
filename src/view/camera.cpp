#include "view/camera.h"

#include <numbers>

namespace evenmesh {
namespace {

constexpr double margin = 0.045;  // share of the picture's smaller side left free on every side

/// Directions of the view: azimuth 0 looks at the front, which is +z where y is up and -y where z is up.
void orient(const RenderOptions& options, Camera& camera) {
  constexpr double radians = std::numbers::pi / 180;
  // Straight from above "up" would have no direction in the picture.
  const double elevation = std::clamp(options.elevation, -89.9, 89.9) * radians, azimuth = options.azimuth * radians;
  const double side = std::cos(elevation) * std::sin(azimuth), front = std::cos(elevation) * std::cos(azimuth);
  const bool z_up = options.up == 'z';
  const Vec3 vertical = z_up ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  camera.towards = z_up ? Vec3{side, -front, std::sin(elevation)} : Vec3{side, std::sin(elevation), front};
  camera.right = normalized(cross(vertical, camera.towards));
  camera.up = cross(camera.towards, camera.right);
}

}  // namespace

Camera fit_camera(const Mesh& mesh, const RenderOptions& options) {
  Camera camera;
  camera.width = options.width;
  camera.height = options.height;
  orient(options, camera);
  const Vec3 middle = mesh.bounds().center();
  Box seen;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) {
      const Vec3 d = mesh.vertices[v] - middle;
      seen.add({dot(d, camera.right), dot(d, camera.up), dot(d, camera.towards)});
    }
  const Vec3 c = seen.center(), size = seen.size();
  camera.center = middle + c.x * camera.right + c.y * camera.up + c.z * camera.towards;
  const double free = 1 - 2 * margin, smaller = std::min(camera.width, camera.height) * (1 - free);
  const double x_scale = (camera.width - smaller) / size.x, y_scale = (camera.height - smaller) / size.y;
  const double scale = std::min(x_scale, y_scale);
  camera.scale = std::isfinite(scale) ? scale : 1;  // all vertices in one point
  return camera;
}

}  // namespace evenmesh
