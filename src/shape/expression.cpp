#include "shape/expression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "evenmesh/error.h"
#include "shape/lexer.h"
#include "shape/suggestions.h"

namespace evenmesh {
namespace {

constexpr int deepest_nesting = 1000;
/// Longer names are not split into products.
constexpr std::size_t longest_run = 64;

struct Function {
  std::string_view name;
  Op op;
  std::size_t operands;  ///< min and max take this many or more
};

constexpr std::array<Function, 16> functions{{{"sin", Op::sin, 1},
                                              {"cos", Op::cos, 1},
                                              {"tan", Op::tan, 1},
                                              {"asin", Op::asin, 1},
                                              {"acos", Op::acos, 1},
                                              {"atan", Op::atan, 1},
                                              {"atan2", Op::atan2, 2},
                                              {"exp", Op::exp, 1},
                                              {"log", Op::log, 1},
                                              {"sqrt", Op::sqrt, 1},
                                              {"abs", Op::abs, 1},
                                              {"min", Op::min, 2},
                                              {"max", Op::max, 2},
                                              {"floor", Op::floor, 1},
                                              {"mod", Op::mod, 2},
                                              {"sign", Op::sign, 1}}};

const Function* find_function(std::string_view name) {
  const auto found =
      std::find_if(functions.begin(), functions.end(), [&](const Function& f) { return f.name == name; });
  return found == functions.end() ? nullptr : &*found;
}

bool is_coordinate(std::string_view name) {
  return name == "x" || name == "y" || name == "z";
}

void check_parameters(const std::map<std::string, double>& parameters) {
  for (const auto& [name, value] : parameters) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    const auto part = [&](char c) { return letter(c) || (c >= '0' && c <= '9'); };
    if (name.empty() || !letter(name[0]) || !std::all_of(name.begin(), name.end(), part))
      throw InvalidInput("parameter '" + name + "': a name is a letter followed by letters, digits and underscores");
    if (is_coordinate(name) || find_function(name))
      throw InvalidInput("parameter '" + name + "': this name has a meaning already; choose another");
    if (!std::isfinite(value)) throw InvalidInput("parameter '" + name + "': the value must be a finite number");
  }
}

/// Recursive descent: equation, sum, product, signed, power, primary.
class Parser {
 public:
  Parser(std::string_view text, const std::map<std::string, double>& parameters)
      : text_(text), parameters_(parameters), tokens_(tokenize(text)) {}

  ExpressionGraph run() {
    if (tokens_.size() == 1) throw InvalidInput("the expression is empty; write for example x^2+y^2+z^2-1");
    NodeId result = sum();
    if (accept('=')) result = builder_.sub(result, sum());
    if (peek().symbol == '=') fail("only one '=' is allowed");
    if (peek().symbol == ')') fail("unexpected ')': no bracket is open");
    if (peek().symbol == ',')
      fail("unexpected ',': commas separate the arguments of a function; decimals take a point");
    if (peek().symbol != 0) fail("expected an operator");
    return builder_.finish(result);
  }

 private:
  /// Counts nested calls for as long as it lives.
  class Nesting {
   public:
    explicit Nesting(Parser& parser) : parser_(parser) {
      if (++parser_.depth_ > deepest_nesting)
        parser_.fail("nested too deeply (more than " + std::to_string(deepest_nesting) + " levels)");
    }
    ~Nesting() { --parser_.depth_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;

   private:
    Parser& parser_;
  };

  const Token& peek() const { return tokens_[at_]; }
  const Token& take() { return tokens_[at_++]; }
  bool accept(char symbol) {
    if (peek().symbol != symbol) return false;
    ++at_;
    return true;
  }
  [[noreturn]] void fail(const std::string& message) const { fail_at(text_, peek().column, message); }

  NodeId sum() {
    NodeId result = product();
    for (;;) {
      if (accept('+'))
        result = builder_.add(result, product());
      else if (accept('-'))
        result = builder_.sub(result, product());
      else
        return result;
    }
  }

  NodeId product() {
    NodeId result = with_sign();
    for (;;) {
      if (accept('*'))
        result = builder_.mul(result, with_sign());
      else if (accept('/'))
        result = builder_.div(result, with_sign());
      else if (peek().symbol == 'i' || peek().symbol == '(')
        result = builder_.mul(result, power());
      else
        return result;
    }
  }

  NodeId with_sign() {
    const Nesting nesting(*this);
    if (accept('-')) return builder_.negate(with_sign());
    if (accept('+')) return with_sign();
    return power();
  }

  NodeId power() {
    const NodeId base = primary();
    return accept('^') ? builder_.pow(base, with_sign()) : base;
  }

  NodeId primary() {
    if (peek().symbol == 'n') return builder_.constant(take().number);
    if (accept('(')) {
      const NodeId inner = sum();
      if (!accept(')')) fail("expected ')'");
      return inner;
    }
    if (peek().symbol == 'i') return name();
    if (peek().symbol == 0) fail("the expression ends where a number, a name or '(' is expected");
    fail("expected a number, a name or '('");
  }

  std::optional<NodeId> value_of(std::string_view name) {
    if (is_coordinate(name)) return builder_.coordinate(name[0] - 'x');
    if (const auto parameter = parameters_.find(std::string(name)); parameter != parameters_.end())
      return builder_.constant(parameter->second);
    if (name == "r") return builder_.radius();
    if (name == "pi") return builder_.constant(std::numbers::pi);
    if (name == "e") return builder_.constant(std::numbers::e);
    return std::nullopt;
  }

  NodeId name() {
    const Token token = peek();
    if (const Function* function = find_function(token.text)) {
      take();
      return call(*function);
    }
    if (const auto value = value_of(token.text)) {
      take();
      return *value;
    }
    return names_run_together(token);
  }

  /// "xz" is x·z: shortest known names from the left; in xy² only y is squared, so the last one takes the power.
  NodeId names_run_together(const Token& token) {
    std::vector<std::string_view> parts;
    std::string_view rest = token.text;
    if (rest.size() > longest_run) fail_unknown(token);
    while (!rest.empty()) {
      std::size_t length = 1;
      // A lone e is too easily a slip (ex for exp) to be multiplied silently.
      while (length <= rest.size() && (rest.substr(0, length) == "e" || !value_of(rest.substr(0, length)))) ++length;
      if (length > rest.size()) fail_unknown(token);
      parts.push_back(rest.substr(0, length));
      rest.remove_prefix(length);
    }
    NodeId result = *value_of(parts[0]);
    for (std::size_t i = 1; i + 1 < parts.size(); ++i) result = builder_.mul(result, *value_of(parts[i]));
    // What is left is read again as a name of its own, so that a power binds to it alone.
    Token& last = tokens_[at_];
    last.column += token.text.size() - parts.back().size();
    last.text = parts.back();
    return builder_.mul(result, power());
  }

  [[noreturn]] void fail_unknown(const Token& token) {
    for (const Function& f : functions) {
      if (token.text.substr(0, f.name.size()) != f.name) continue;
      const std::string_view rest = token.text.substr(f.name.size());
      if (!rest.empty() && (value_of(rest) || (rest[0] >= '0' && rest[0] <= '9')))
        fail("functions need brackets: " + std::string(f.name) + "(" + std::string(rest) + ")");
    }
    std::vector<std::string_view> names{"pi", "x", "y", "z"};
    for (const Function& f : functions) names.push_back(f.name);
    for (const auto& [known, value] : parameters_) names.push_back(known);
    fail("unknown name '" + std::string(token.text.substr(0, 40)) + "'" + did_you_mean(token.text, names));
  }

  NodeId call(const Function& function) {
    const Nesting nesting(*this);
    const std::string name(function.name);
    if (!accept('(')) fail("expected '(' after '" + name + "'");
    std::vector<NodeId> operands;
    do {
      operands.push_back(sum());
    } while (accept(','));
    if (peek().symbol != ')') fail("expected ')'");
    const bool any_number = function.op == Op::min || function.op == Op::max;
    if (operands.size() < function.operands || (operands.size() > function.operands && !any_number))
      fail("'" + name + "' takes " + std::to_string(function.operands) +
           (any_number               ? " or more arguments"
            : function.operands == 1 ? " argument"
                                     : " arguments") +
           ", not " + std::to_string(operands.size()));
    take();
    if (function.operands == 1) return builder_.function(function.op, operands[0]);
    NodeId result = builder_.function(function.op, operands[0], operands[1]);
    for (std::size_t i = 2; i < operands.size(); ++i) result = builder_.function(function.op, result, operands[i]);
    return result;
  }

  std::string_view text_;
  const std::map<std::string, double>& parameters_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  int depth_ = 0;
  GraphBuilder builder_;
};

}  // namespace

ExpressionGraph parse_expression(std::string_view text, const std::map<std::string, double>& parameters) {
  check_parameters(parameters);
  return Parser(text, parameters).run();
}

}  // namespace evenmesh
