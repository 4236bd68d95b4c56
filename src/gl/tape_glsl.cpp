#include "gl/tape_glsl.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace evenmesh::gl {
namespace {

/// The same bits, whatever the compiler makes of decimals.
std::string literal(float value) {
  return fmt::format("uintBitsToFloat({:#x}u)", std::bit_cast<std::uint32_t>(value));
}

/// The value of an instruction; {0} and {1} stand for the operands, {2} and {3} for the numbers s and t.
std::string_view value_format(Op op) {
  switch (op) {
    case Op::affine:
      return "{2} * {0} + {3}";
    case Op::blend:
      return "{2} * {0} + {3} * {1}";
    case Op::add:
      return "{0} + {1}";
    case Op::sub:
      return "{0} - {1}";
    case Op::mul:
      return "{0} * {1}";
    case Op::square:
      return "{0} * {0}";
    case Op::div:
      return "{0} / {1}";
    case Op::sqrt:
      return "em_sqrt({0})";
    case Op::sin:
      return "em_sin({0})";
    case Op::cos:
      return "em_cos({0})";
    case Op::tan:
      return "em_tan({0})";
    case Op::asin:
      return "em_asin({0})";
    case Op::acos:
      return "em_acos({0})";
    case Op::atan:
      return "em_atan({0})";
    case Op::atan2:
      return "em_atan2({0}, {1})";
    case Op::exp:
      return "em_exp({0})";
    case Op::log:
      return "em_log({0})";
    case Op::pow:
      return "em_pow({0}, {1})";
    case Op::abs:
      return "em_abs({0})";
    case Op::min:
      return "em_min({0}, {1})";
    case Op::max:
      return "em_max({0}, {1})";
    case Op::floor:
      return "em_floor({0})";
    case Op::mod:
      return "em_mod({0}, {1})";
    case Op::sign:
      return "em_sign({0})";
    case Op::x:
    case Op::y:
    case Op::z:
    case Op::constant:
      break;
  }
  return "0.0";
}

/// Derivatives by the operands, {0} and {1}.
struct FactorFormats {
  std::string_view a, b = "0.0";
};

FactorFormats factor_formats(Op op) {
  switch (op) {
    case Op::affine:
      return {"{2}"};
    case Op::blend:
      return {"{2}", "{3}"};
    case Op::add:
      return {"1.0", "1.0"};
    case Op::sub:
      return {"1.0", "-1.0"};
    case Op::mul:
      return {"{1}", "{0}"};
    case Op::square:
      return {"{0} + {0}"};
    case Op::div:
      return {"1.0 / {1}", "-(({0} / {1}) / {1})"};
    case Op::sqrt:
      return {"em_over(0.5, em_sqrt({0}))"};
    case Op::sin:
      return {"em_cos({0})"};
    case Op::cos:
      return {"-em_sin({0})"};
    case Op::tan:
      return {"em_tan_factor({0})"};
    case Op::asin:
      return {"em_over(1.0, em_other_leg({0}))"};
    case Op::acos:
      return {"em_over(-1.0, em_other_leg({0}))"};
    case Op::atan:
      return {"em_atan_factor({0})"};
    case Op::atan2:
      return {"em_atan2_factor({1}, {0}, {1})", "em_atan2_factor(-{0}, {0}, {1})"};
    case Op::exp:
      return {"em_exp({0})"};
    case Op::log:
      return {"em_over(1.0, {0})"};
    case Op::pow:
      return {"em_pow_factor_a({0}, {1})", "em_pow_factor_b({0}, {1})"};
    case Op::abs:
      return {"em_copysign(1.0, {0})"};
    case Op::mod:
      return {"1.0", "-em_quotient({0}, {1})"};
    default:
      return {"0.0"};
  }
}

constexpr std::array axes{"x", "y", "z"};

class Writer {
 public:
  Writer(const Tape& tape, bool gradient) : tape_(tape), gradient_(gradient), names_(tape.register_count()) {
    for (std::size_t axis = 0; axis < 3; ++axis) names_[axis] = fmt::format("p.{}", axes[axis]);
    for (std::size_t i = 0; i < tape.constant_count; ++i) names_[3 + i] = literal(tape.constants[i * tape_chunk]);
  }

  std::string write() {
    text_ = gradient_ ? "vec4 em_gradient(vec3 p) {\n" : "float map(vec3 p) {\n";
    for (const Instruction& c : tape_.code) add(c);
    const std::string& result = names_[tape_.code.back().dst];
    text_ += "  return ";
    text_ += gradient_ ? fmt::format("vec4({}, {}, {}, {})", result, slope(result, tape_.mask, 0),
                                     slope(result, tape_.mask, 1), slope(result, tape_.mask, 2))
                       : result;
    return std::move(text_) + ";\n}\n";
  }

 private:
  /// Every instruction has variables of its own: f7, and f7_x, f7_y, f7_z, those of them that are not 0.
  void add(const Instruction& c) {
    const std::string name = fmt::format("f{}", count_++), a = names_[c.a], b = names_[c.b];
    const std::string s = literal(c.s), t = literal(c.t);
    const auto filled = [&](std::string_view format) { return fmt::format(fmt::runtime(format), a, b, s, t); };
    text_ += fmt::format("  precise float {} = {};\n", name, filled(value_format(c.op)));
    names_[c.dst] = name;
    const bool flat = c.op == Op::floor || c.op == Op::sign;
    if (!gradient_ || flat || (c.mask_a | c.mask_b) == 0) return;
    const bool choice = c.op == Op::min || c.op == Op::max;
    if (choice) {
      text_ += fmt::format("  bool {}_a = {} {} {};\n", name, a, c.op == Op::min ? "<" : ">", b);
    } else {
      const FactorFormats formats = factor_formats(c.op);
      if (c.mask_a) text_ += fmt::format("  precise float {}_a = {};\n", name, filled(formats.a));
      if (c.mask_b) text_ += fmt::format("  precise float {}_b = {};\n", name, filled(formats.b));
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (((c.mask_a | c.mask_b) >> axis & 1) == 0) continue;
      const std::string da = slope(a, c.mask_a, axis), db = slope(b, c.mask_b, axis);
      const std::string first = fmt::format("{}_a * {}", name, da), second = fmt::format("{}_b * {}", name, db);
      const bool has_a = c.mask_a >> axis & 1, has_b = c.mask_b >> axis & 1;
      const std::string sum = choice           ? fmt::format("{}_a ? {} : {}", name, da, db)
                              : has_a && has_b ? first + " + " + second
                              : has_a          ? first
                                               : second;
      text_ += fmt::format("  precise float {}_{} = {};\n", name, axes[static_cast<std::size_t>(axis)], sum);
    }
  }

  /// A derivative of a value that depends on the coordinates of the mask.
  static std::string slope(const std::string& name, std::uint8_t mask, int axis) {
    if ((mask >> axis & 1) == 0) return "0.0";
    if (name.starts_with("p.")) return "1.0";
    return fmt::format("{}_{}", name, axes[static_cast<std::size_t>(axis)]);
  }

  const Tape& tape_;
  bool gradient_;
  std::vector<std::string> names_;  ///< of what each register holds
  std::size_t count_ = 0;
  std::string text_;
};

}  // namespace

std::string glsl_of_tape(const Tape& tape) {
  return Writer(tape, false).write();
}

std::string glsl_of_tape_gradient(const Tape& tape) {
  return Writer(tape, true).write();
}

}  // namespace evenmesh::gl
