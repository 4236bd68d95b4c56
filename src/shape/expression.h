#pragma once
/// Formulas as people write them, turned into programs.

#include <map>
#include <string>
#include <string_view>

#include "shape/expression_graph.h"

namespace evenmesh {

/// Parses a formula in x, y, z; the language is described at shape_from_expression.
///
/// Beyond it: ** for ^, superscripts (x²), π, −, ·, ×; names that run together are split where every part is known
/// (16xz); a parameter may hide r, e and pi, but no coordinate and no function. 1/2x is (1/2)·x; 2^-3 is 2^(−3).
/// @throws InvalidInput  with column and caret; also for parameters that are not finite or have impossible names
/// Cost: linear in the length, at most 100,000 bytes and 1,000 nested brackets, signs and powers.
ExpressionGraph parse_expression(std::string_view text, const std::map<std::string, double>& parameters = {});

}  // namespace evenmesh
