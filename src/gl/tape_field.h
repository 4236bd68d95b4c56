#pragma once
/// Expressions on the device.

#include <memory>

#include "gl/context.h"
#include "shape/expression_graph.h"
#include "shape/field.h"

namespace evenmesh::gl {

/// The field of an expression graph (see make_graph_field()) with values and gradients from the device; see tape_glsl.h
/// for how near they come. Enclosures and single points are the CPU's, in double precision. Not specialized to boxes.
///
/// Cost: compiles two shaders, some 0.1 s, more for long programs. Evaluations throw UnusableInput if the driver does
/// not come back.
std::shared_ptr<const Field> make_tape_field(std::shared_ptr<Context> context, const ExpressionGraph& graph);

/// Operations from which on compilers of drivers take too long.
inline constexpr std::size_t longest_tape = 2000;

/// Whether a field is one of these.
bool is_tape_field(const Field& field);

}  // namespace evenmesh::gl
