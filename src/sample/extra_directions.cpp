#include "sample/extra_directions.h"

#include <algorithm>
#include <cmath>

#include "evenmesh/repair.h"
#include "geometry/triangle.h"
#include "sample/scan.h"

namespace evenmesh {
namespace {

/// Whether a point, in cells from the grid's origin, is inside by the nearest ray of one axis.
bool inside_along(const TriDexel& rays, std::size_t axis, const std::array<double, 3>& at) {
  const double p = std::round(at[std::size_t(dexel_p_axis[axis])]), q = std::round(at[std::size_t(dexel_q_axis[axis])]);
  if (!(p >= 0 && q >= 0 && p < 65536 && q < 65536)) return false;
  bool inside = false;
  for (const DexelCrossing& c : rays.axes[axis].ray(static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(q))) {
    if (c.cell + double(c.t) > at[axis]) break;
    inside = c.enters;
  }
  return inside;
}

}  // namespace

ExtraDirections::ExtraDirections(const Mesh& mesh, double spacing, Winding winding, ExecutionContext& context) {
  for (const Affine& turn : {Affine::rotate({1, 2, 3}, 41), Affine::rotate({-2, 1, 1.4}, 73)}) {
    Mesh turned = mesh;
    for (Vec3& v : turned.vertices) v = turn(v);
    const Box box = turned.bounds();
    const double cells = std::clamp(std::ceil(box.longest_side() / spacing), 8.0, 8192.0);
    frames_.push_back({turn, scan_rays(turned, make_grid(box, static_cast<std::size_t>(cells)), context, winding)});
  }
}

int ExtraDirections::inside(const Vec3& p) const {
  int count = 0;
  for (const Frame& frame : frames_) {
    const Grid& grid = frame.rays.grid;
    const Vec3 at = (frame.turn(p) - grid.origin) / grid.spacing;
    for (std::size_t axis = 0; axis < 3; ++axis) count += inside_along(frame.rays, axis, {at.x, at.y, at.z});
  }
  return count;
}

double agreement(const TriDexel& rays) {
  std::size_t agreed = 0, any = 0;
  const auto& size = rays.grid.size;
  for (std::uint32_t k = 0; k < size[2]; ++k)
    for (std::uint32_t j = 0; j < size[1]; ++j)
      for (std::uint32_t i = 0; i < size[0]; ++i) {
        int count = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
          count += inside_along(rays, axis, {double(i), double(j), double(k)});
        agreed += count == 3;
        any += count > 0;
      }
  return any == 0 ? 0 : static_cast<double>(agreed) / static_cast<double>(any);
}

namespace {

/// What the rays of one axis pass of the solid.
double volume_along(const TriDexel& rays, std::size_t axis) {
  double cells = 0;
  for (const DexelSlab& slab : rays.axes[axis].slabs)
    for (const DexelCrossing& c : slab.crossings) cells += (c.enters ? -1 : 1) * (c.cell + double(c.t));
  return cells * std::pow(rays.grid.spacing, 3);
}

}  // namespace

Solidity measure_solidity(const Mesh& mesh, ExecutionContext& context) {
  constexpr std::size_t resolution = 64;
  const TriDexel rays = scan_rays(mesh, make_grid(mesh.bounds(), resolution), context);
  Solidity solidity{agreement(rays), {}};
  if (!rays.closed) return solidity;
  // Rays that meet the solid's runs by chance see more of a thin part than there is.
  double volume = std::min({volume_along(rays, 0), volume_along(rays, 1), volume_along(rays, 2)});
  for (const ThinSpot& spot : rays.thin) volume += spot.gap ? 0 : double(spot.thickness) * spot.area;
  solidity.thickness = 2 * volume / area_of(mesh);
  // All of a thin plate may lie between the grid points, of which any direction would say the same.
  if (solidity.share == 0 && volume > 0) solidity.share = 1;
  return solidity;
}

double solidity(const Mesh& mesh, ExecutionContext& context) {
  return with_threads(context, [&] { return measure_solidity(mesh, context).share; });
}

}  // namespace evenmesh
