#pragma once
/// Forms of expressions on OpenGL, for the tests that run on every form (shape/forms.h).

#include <optional>
#include <string>

#include "evenmesh/glsl.h"
#include "gl/shader_files.h"
#include "gl/tape_glsl.h"
#include "shape/expression_field.h"
#include "shape/forms.h"
#include "shape/tape.h"

namespace evenmesh::testing {

/// The text of an expression in GLSL, with functions of its own: nothing depends on those of a driver.
inline std::string glsl_of(const ExpressionGraph& graph) {
  std::string text;
  for (const gl::ShaderFile& file : gl::shader_files())
    if (file.name == "tape_math.glsl") text = file.text;
  return text + gl::glsl_of_tape(compile_tape(graph));
}

/// Compilers of shaders take some 30 ms for a formula. No multiple of 5, since random_formulas() has depths that
/// repeat.
inline constexpr int formula_cost = 19;

/// The tape on OpenGL: values and gradients from there, the rest from the CPU.
inline const Form on_device{.name = "tape_on_gl",
                            .of =
                                [](const Shape& shape, double) {
                                  Shape moved = on_gl(shape);
                                  EXPECT_TRUE(runs_on_gl(moved)) << shape.name;
                                  return moved;
                                },
                            .cost = formula_cost,
                            .expressions_only = true};

/// The same function as a user's shader: everything from OpenGL, gradients by differences, no intervals unless the
/// slope is given.
inline const Form as_shader{.name = "glsl",
                            .of =
                                [](const Shape& shape, double slope) {
                                  GlslOptions options{.bounds = shape.bounds};
                                  if (slope > 0) options.lipschitz = slope;
                                  Shape made = shape_from_glsl(glsl_of(*graph_of(*shape.field())), options, shape.name);
                                  made.bounds = shape.bounds, made.capped_by_bounds = shape.capped_by_bounds;
                                  return made;
                                },
                            .cost = formula_cost,
                            .expressions_only = true,
                            .roots = 4e-3,
                            .keeps_infinities = false};

}  // namespace evenmesh::testing
