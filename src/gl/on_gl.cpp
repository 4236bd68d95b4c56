#include <memory>
#include <utility>

#include "evenmesh/glsl.h"
#include "evenmesh/solid.h"
#include "gl/context.h"
#include "gl/glsl_field.h"
#include "gl/tape_field.h"
#include "shape/affine_field.h"
#include "shape/expression_field.h"

namespace evenmesh {
namespace {

/// The shape with its innermost fields replaced; what does not change is shared with the old one.
Shape with_fields(const Shape& shape, const Replacement& replace) {
  Shape made = shape;
  if (shape.field()) made.what = with_innermost(std::get<std::shared_ptr<const Field>>(shape.what), replace);
  const Compound* compound = shape.compound();
  if (!compound) return made;
  Compound fresh{compound->kind, {}, compound->distance};
  bool changed = false;
  for (const Shape& operand : compound->operands) {
    fresh.operands.push_back(with_fields(operand, replace));
    changed = changed || fresh.operands.back().what != operand.what;
  }
  if (changed) made.what = std::make_shared<const Compound>(std::move(fresh));
  return made;
}

}  // namespace

Shape on_gl(const Shape& shape, const std::string& device) {
  return with_fields(shape, [&](const std::shared_ptr<const Field>& field) {
    const ExpressionGraph* graph = graph_of(*field);
    if (!graph || graph->nodes.size() > gl::longest_tape) return field;
    return gl::make_tape_field(gl::shared_context(device), *graph);
  });
}

bool runs_on_gl(const Shape& shape) {
  bool found = false;
  with_fields(shape, [&](const std::shared_ptr<const Field>& field) {
    found = found || gl::is_tape_field(*field) || dynamic_cast<const gl::GlslField*>(field.get());
    return field;
  });
  return found;
}

}  // namespace evenmesh
