#include "evenmesh/glsl.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "evenmesh/error.h"
#include "gl/context.h"
#include "gl/glsl_field.h"
#include "gl/glsl_source.h"

namespace evenmesh {
namespace {

/// A few points: an endless loop or a device that fails shows before the sampling begins.
void probe(const gl::GlslField& field, const Box& box) {
  constexpr int side = 3;
  std::vector<float> x, y, z;
  for (int i = 0; i < side * side * side; ++i) {
    const auto along = [&](int axis, int step) {
      return static_cast<float>(box.lo[axis] + (step + 0.37) / side * (box.hi[axis] - box.lo[axis]));
    };
    x.push_back(along(0, i % side));
    y.push_back(along(1, i / side % side));
    z.push_back(along(2, i / side / side));
  }
  std::vector<float> values(x.size());
  field.evaluate(PointBatch{x, y, z}, values);
}

}  // namespace

Shape shape_from_glsl(std::string source, const GlslOptions& options, std::string name) {
  const bool unit = options.bounds == Box{};
  const Box box = unit ? Box{{-1, -1, -1}, {1, 1, 1}} : options.bounds;
  if (box.empty() || !is_finite(box.lo) || !is_finite(box.hi) || !(box.longest_side() > 0))
    throw InvalidInput("the bounds are empty; give a box with x0 < x1, y0 < y1 and z0 < z1");
  if (options.lipschitz && !(std::isfinite(*options.lipschitz) && *options.lipschitz > 0))
    throw InvalidInput(fmt::format("the Lipschitz constant must be above 0, not {}", *options.lipschitz));
  if (!std::isfinite(options.level)) throw InvalidInput("the level must be a finite number");
  gl::GlslSource prepared = gl::prepare_glsl({std::move(source), name}, options.entry, options.definitions);
  auto field =
      std::make_shared<gl::GlslField>(gl::shared_context(options.device), std::move(prepared),
                                      gl::FieldTraits{0.5 * box.longest_side(), options.level, options.lipschitz});
  probe(*field, box);
  return Shape{std::move(name), options.bounds, std::shared_ptr<const Field>(std::move(field))};
}

std::string gl_renderer(const std::string& device) {
  const std::shared_ptr<gl::Context> context = gl::shared_context(device);
  return fmt::format("{}, OpenGL {}", context->renderer(), context->version());
}

bool gl_stuck() {
  return gl::stuck();
}

}  // namespace evenmesh
