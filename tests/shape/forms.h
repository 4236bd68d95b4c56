#pragma once
/// The forms in which the same function may be evaluated. Tests of fields are written once and run on each form: here
/// and in the rooms above on the CPU, in the room gl on OpenGL.

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "evenmesh/shape.h"
#include "shape/expression_field.h"
#include "shape/field.h"

namespace evenmesh::testing {

struct Form {
  const char* name;
  /// The solid of an expression in this form.
  /// @param slope  |f(p) − f(q)| ≤ slope · |p − q|, for forms that use it; 0: not known
  Shape (*of)(const Shape& shape, double slope);
  int cost = 1;                   ///< of a formula: where there are many, every cost-th is taken
  bool expressions_only = false;  ///< no other shapes of the gallery have this form
  double roots = 1e-4;            ///< how near samples come to roots, cells
  bool keeps_infinities = true;   ///< else minus infinity is no number

  Shape operator()(const Shape& shape, double slope = 0) const { return of(shape, slope); }
  std::shared_ptr<const Field> field(std::string_view text, double slope = 0) const {
    return std::get<std::shared_ptr<const Field>>(of(shape_from_expression(text), slope).what);
  }
  bool has(const Shape& shape) const { return !expressions_only || graph_of(*shape.field()) != nullptr; }
  /// Every cost-th of a list, the first in any case.
  template <typename T>
  std::vector<T> some(const std::vector<T>& list) const {
    std::vector<T> taken;
    for (std::size_t i = 0; i < list.size(); i += static_cast<std::size_t>(cost)) taken.push_back(list[i]);
    return taken;
  }
  friend void PrintTo(const Form& form, std::ostream* out) { *out << form.name; }
};

/// The tape that every expression is on the CPU.
inline const Form on_cpu{"cpu", [](const Shape& shape, double) { return shape; }};

/// A test that runs on each form.
using FormTest = ::testing::TestWithParam<Form>;

inline std::string name_of_form(const ::testing::TestParamInfo<Form>& info) {
  return info.param.name;
}

}  // namespace evenmesh::testing
