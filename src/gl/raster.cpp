#include "evenmesh/raster.h"

#include <fmt/format.h>

#include <limits>

#include "evenmesh/error.h"
#include "gl/raster_sampler.h"

namespace evenmesh {
namespace {

Box bounds_of(const RasterOptions& options, const std::string& name) {
  const bool given = options.bounds != Box{};
  if (!given && options.geometry.triangles.empty())
    throw InvalidInput("'" + name +
                       "' is drawn without geometry, so it is not known where it is: give --bounds x0,y0,z0,x1,y1,z1");
  const Box box = given ? options.bounds : options.geometry.bounds();
  if (box.empty() || !is_finite(box.lo) || !is_finite(box.hi) || !(box.longest_side() > 0))
    throw InvalidInput("the bounds are empty; give a box with x0 < x1, y0 < y1 and z0 < z1");
  return box;
}

void check_drawing(const RasterOptions& options, const std::string& name) {
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
  if (options.geometry.triangles.size() > most / 3 || options.vertex_count > most)
    throw InvalidInput(fmt::format("'{}' draws more than {} vertices; draw fewer", name, most));
  if (!options.geometry.triangles.empty()) {
    shape_from_mesh(options.geometry, name);  // which checks it
    return;
  }
  if (options.vertex_count == 0)
    throw InvalidInput("'" + name + "' draws nothing: give a mesh, or a number of vertices");
  if (options.vertex.empty())
    throw InvalidInput("'" + name + "' has neither a mesh nor a vertex shader: give one of them");
  if (options.vertex_count % 3 != 0)
    throw InvalidInput(fmt::format("'{}' draws {} vertices, which are not triangles: give a multiple of 3", name,
                                   options.vertex_count));
}

}  // namespace

Shape shape_from_raster(const RasterOptions& options, std::string name) {
  check_drawing(options, name);
  const Box bounds = bounds_of(options, name);
  gl::RasterSource source = gl::prepare_raster({options.vertex, options.vertex_name},
                                               {options.fragment, options.fragment_name}, options.definitions);
  auto device = std::make_shared<gl::RasterDevice>(gl::shared_context(options.device), std::move(source),
                                                   options.geometry, options.vertex_count);
  auto sampler = std::make_shared<const gl::RasterSampler>(std::move(device), name, bounds);
  return Shape{std::move(name), bounds, std::shared_ptr<const RaySource>(std::move(sampler))};
}

}  // namespace evenmesh
