#pragma once
/// A program as a field.

#include <memory>

#include "shape/expression_graph.h"
#include "shape/field.h"

namespace evenmesh {

/// Values and gradients in vectors of floats, intervals that enclose them, and single points in double precision.
/// Cost: about 0.05 ns per point and arithmetic operation where vectors are 256 bits wide.
std::shared_ptr<const Field> make_graph_field(ExpressionGraph graph);

/// The program of such a field; nullptr where the field is another one.
const ExpressionGraph* graph_of(const Field& field);

}  // namespace evenmesh
