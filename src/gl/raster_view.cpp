#include "gl/raster_view.h"

#include <cmath>

#include "grid/tri_dexel.h"

namespace evenmesh::gl {
namespace {

std::array<float, 3> floats(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

std::array<float, 16> matrix(const Affine& map) {
  std::array<float, 16> m{};
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3& column = c < 3 ? map.column[c] : map.translation;
    for (int r = 0; r < 3; ++r) m[4 * c + static_cast<std::size_t>(r)] = static_cast<float>(column[r]);
  }
  m[15] = 1;
  return m;
}

/// From the world to the screen: x, y and depth, each from −1 to 1.
Affine projection(const Grid& grid, const RayWindow& window) {
  const auto axis = static_cast<std::size_t>(window.axis);
  const std::array<int, 3> world{dexel_p_axis[axis], dexel_q_axis[axis], window.axis};
  const double cells = grid.size[axis] - 1.0;
  const std::array<double, 3> first{window.p - 0.5, window.q - 0.5, 0.0},
      extent{double(window.width), double(window.height), cells};
  Affine map;
  map.column = {};
  for (int screen = 0; screen < 3; ++screen) {
    const auto s = static_cast<std::size_t>(screen);
    const int w = world[s];
    const double scale = 2 / (grid.spacing * extent[s]);
    map.column[static_cast<std::size_t>(w)][screen] = scale;
    map.translation[screen] = -grid.origin[w] * scale - 2 * first[s] / extent[s] - 1;
  }
  return map;
}

}  // namespace

RasterView make_view(const Grid& grid, const RayWindow& window, const Affine& placement, const Box& bounds) {
  const Affine to_screen = projection(grid, window).after(placement), back = placement.inverse();
  Vec3 direction;
  direction[window.axis] = 1;
  RasterView view;
  view.axis = window.axis;
  view.width = static_cast<int>(window.width);
  view.height = static_cast<int>(window.height);
  view.view_projection = matrix(to_screen);
  view.inverse = matrix(to_screen.inverse());
  view.direction = floats(normalized(back.direction(direction)));
  view.low = floats(bounds.lo);
  view.high = floats(bounds.hi);
  for (std::size_t c = 0; c < 3; ++c) view.back[c] = floats(back.column[c]);
  view.pixel_size = static_cast<float>(grid.spacing / std::cbrt(std::abs(placement.determinant())));
  view.cells = static_cast<float>(grid.size[static_cast<std::size_t>(window.axis)] - 1.0);
  // The eye looks along +z of the screen, so a right-handed world is seen mirrored.
  view.clockwise = to_screen.determinant() > 0;
  return view;
}

}  // namespace evenmesh::gl
