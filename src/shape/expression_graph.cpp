#include "shape/expression_graph.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "core/random.h"

namespace evenmesh {
namespace {

/// Larger whole exponents go through exp and log: nobody writes them, and products lose as much.
constexpr double largest_product_power = 1024;

double apply_pow(double a, double b) {
  if (b == 0) return 1;
  return a < 0 ? std::numeric_limits<double>::quiet_NaN() : std::pow(a, b);
}

}  // namespace

int operand_count(Op op) {
  switch (op) {
    case Op::x:
    case Op::y:
    case Op::z:
    case Op::constant:
      return 0;
    case Op::blend:
    case Op::add:
    case Op::sub:
    case Op::mul:
    case Op::div:
    case Op::atan2:
    case Op::pow:
    case Op::min:
    case Op::max:
    case Op::mod:
      return 2;
    default:
      return 1;
  }
}

double apply(const Node& node, double a, double b) {
  switch (node.op) {
    case Op::constant:
      return node.s;
    case Op::affine:
      return node.s * a + node.t;
    case Op::blend:
      return node.s * a + node.t * b;
    case Op::add:
      return a + b;
    case Op::sub:
      return a - b;
    case Op::mul:
      return a * b;
    case Op::square:
      return a * a;
    case Op::div:
      return a / b;
    case Op::sqrt:
      return std::sqrt(a);
    case Op::sin:
      return std::sin(a);
    case Op::cos:
      return std::cos(a);
    case Op::tan:
      return std::tan(a);
    case Op::asin:
      return std::asin(a);
    case Op::acos:
      return std::acos(a);
    case Op::atan:
      return std::atan(a);
    case Op::atan2:
      return std::atan2(a, b);
    case Op::exp:
      return std::exp(a);
    case Op::log:
      return std::log(a);
    case Op::pow:
      return apply_pow(a, b);
    case Op::abs:
      return std::abs(a);
    case Op::min:
      return a < b ? a : b;
    case Op::max:
      return a > b ? a : b;
    case Op::floor:
      return std::floor(a);
    case Op::mod:
      return a - b * std::floor(a / b);
    case Op::sign:
      return a > 0 ? 1.0 : a < 0 ? -1.0 : 0.0;
    case Op::x:
    case Op::y:
    case Op::z:
      break;
  }
  return 0;
}

std::size_t GraphBuilder::KeyHash::operator()(const Key& key) const {
  Random mix(key.s ^ (key.t << 1) ^ (static_cast<std::uint64_t>(key.op) << 56) ^
             (static_cast<std::uint64_t>(key.a) << 28) ^ key.b);
  return static_cast<std::size_t>(mix.bits());
}

GraphBuilder::GraphBuilder() {
  node(Op::x);
  node(Op::y);
  node(Op::z);
}

NodeId GraphBuilder::node(Op op, NodeId a, NodeId b, double s, double t) {
  const Key key{op, a, b, std::bit_cast<std::uint64_t>(s), std::bit_cast<std::uint64_t>(t)};
  const auto [entry, is_new] = known_.try_emplace(key, static_cast<NodeId>(nodes_.size()));
  if (is_new) nodes_.push_back({op, a, b, s, t});
  return entry->second;
}

NodeId GraphBuilder::constant(double value) {
  return node(Op::constant, 0, 0, value);
}

NodeId GraphBuilder::radius() {
  return function(Op::sqrt, add(add(square(coordinate(0)), square(coordinate(1))), square(coordinate(2))));
}

GraphBuilder::Linear GraphBuilder::linear(NodeId a) const {
  const Node& n = nodes_[a];
  if (n.op == Op::constant) return {0.0, n.s, a};
  if (n.op == Op::affine) return {n.s, n.t, n.a};
  return {1.0, 0.0, a};
}

NodeId GraphBuilder::affine(NodeId a, double scale, double offset) {
  const Linear inner = linear(a);
  const double s = scale * inner.scale, t = scale * inner.offset + offset;
  if (s == 0) return constant(t);
  if (s == 1 && t == 0) return inner.base;
  return node(Op::affine, inner.base, 0, s, t);
}

NodeId GraphBuilder::combine(NodeId a, NodeId b, double sign) {
  const Linear p = linear(a), q = linear(b);
  const double scale = sign * q.scale, offset = p.offset + sign * q.offset;
  if (p.scale == 0) return affine(q.base, scale, offset);
  if (q.scale == 0) return affine(p.base, p.scale, offset);
  if (p.base == q.base) return affine(p.base, p.scale + scale, offset);
  // A common factor and all offsets are applied to the sum, once, instead of to its parts.
  if (p.scale == scale) {
    const auto [first, second] = std::minmax(p.base, q.base);
    return affine(node(Op::add, first, second), scale, offset);
  }
  if (p.scale == -scale) return affine(node(Op::sub, p.base, q.base), p.scale, offset);
  return affine(node(Op::blend, p.base, q.base, p.scale, scale), 1.0, offset);
}

NodeId GraphBuilder::mul(NodeId a, NodeId b) {
  if (is_constant(a)) return affine(b, nodes_[a].s, 0.0);
  if (is_constant(b)) return affine(a, nodes_[b].s, 0.0);
  if (a == b) return square(a);
  const Linear p = linear(a), q = linear(b);
  double scale = 1;
  if (p.offset == 0) {
    scale *= p.scale;
    a = p.base;
  }
  if (q.offset == 0) {
    scale *= q.scale;
    b = q.base;
  }
  if (a == b) return affine(square(a), scale, 0.0);
  if (a > b) std::swap(a, b);
  return affine(node(Op::mul, a, b), scale, 0.0);
}

NodeId GraphBuilder::square(NodeId a) {
  if (is_constant(a)) return constant(nodes_[a].s * nodes_[a].s);
  const Linear p = linear(a);
  if (p.offset == 0 && p.scale != 1) return affine(square(p.base), p.scale * p.scale, 0.0);
  if (nodes_[a].op == Op::abs) return square(nodes_[a].a);
  if (nodes_[a].op == Op::sqrt && nonnegative(nodes_[a].a)) return nodes_[a].a;
  return node(Op::square, a);
}

bool GraphBuilder::nonnegative(NodeId a) const {
  // Sums are looked into as deep as √(x² + y² + z²) and its like need.
  const auto visit = [this](const auto& self, NodeId n, int depth) -> bool {
    const Node& p = nodes_[n];
    switch (p.op) {
      case Op::square:
      case Op::abs:
      case Op::sqrt:
      case Op::exp:
        return true;
      case Op::constant:
        return p.s >= 0;
      case Op::affine:
        return depth > 0 && p.s >= 0 && p.t >= 0 && self(self, p.a, depth - 1);
      case Op::add:
        return depth > 0 && self(self, p.a, depth - 1) && self(self, p.b, depth - 1);
      case Op::blend:
        return depth > 0 && p.s >= 0 && p.t >= 0 && self(self, p.a, depth - 1) && self(self, p.b, depth - 1);
      default:
        return false;
    }
  };
  return visit(visit, a, 6);
}

NodeId GraphBuilder::div(NodeId a, NodeId b) {
  if (is_constant(b) && nodes_[b].s != 0) return affine(a, 1.0 / nodes_[b].s, 0.0);
  if (is_constant(a) && is_constant(b)) return constant(nodes_[a].s / nodes_[b].s);
  const Linear p = linear(a), q = linear(b);
  double scale = 1;
  if (p.offset == 0 && p.scale != 0) {
    scale *= p.scale;
    a = p.base;
  }
  if (q.offset == 0 && q.scale != 0) {
    scale /= q.scale;
    b = q.base;
  }
  return affine(node(Op::div, a, b), scale, 0.0);
}

NodeId GraphBuilder::power(NodeId a, std::uint32_t exponent) {
  NodeId result = 0;
  bool empty = true;
  for (;; exponent >>= 1, a = mul(a, a)) {
    if (exponent & 1) {
      result = empty ? a : mul(result, a);
      empty = false;
    }
    if (exponent <= 1) return result;
  }
}

NodeId GraphBuilder::pow(NodeId a, NodeId b) {
  if (!is_constant(b)) return node(Op::pow, a, b);
  const double exponent = nodes_[b].s, size = std::abs(exponent), whole = std::floor(size);
  const bool half = size - whole == 0.5;
  if (exponent == 0) return constant(1.0);
  if ((size != whole && !half) || size > largest_product_power)
    return is_constant(a) ? constant(apply_pow(nodes_[a].s, exponent)) : node(Op::pow, a, b);
  NodeId result = whole > 0 ? power(a, static_cast<std::uint32_t>(whole)) : constant(1.0);
  if (half) result = mul(result, function(Op::sqrt, a));
  return exponent > 0 ? result : div(constant(1.0), result);
}

NodeId GraphBuilder::function(Op op, NodeId a) {
  if (is_constant(a)) return constant(apply(Node{op}, nodes_[a].s, 0.0));
  if (op == Op::abs) {
    const Linear p = linear(a);
    if (p.offset == 0 && p.scale != 1) return affine(function(op, p.base), std::abs(p.scale), 0.0);
    if (nonnegative(a)) return a;
  }
  return node(op, a);
}

NodeId GraphBuilder::function(Op op, NodeId a, NodeId b) {
  if (is_constant(a) && is_constant(b)) return constant(apply(Node{op}, nodes_[a].s, nodes_[b].s));
  if (a == b && (op == Op::min || op == Op::max)) return a;
  return node(op, a, b);
}

ExpressionGraph GraphBuilder::finish(NodeId result) const {
  ExpressionGraph graph{std::vector<Node>(nodes_.begin(), nodes_.begin() + result + 1)};
  // The tape needs something to execute: a bare coordinate or constant is copied, as 1·a + 0.
  if (operand_count(nodes_[result].op) == 0) graph.nodes.push_back({Op::affine, result, 0, 1.0, 0.0});
  return without_unused(graph);
}

ExpressionGraph without_unused(const ExpressionGraph& graph) {
  const std::vector<Node>& nodes = graph.nodes;
  std::vector<char> used(nodes.size(), 0);
  used.back() = 1;
  for (std::size_t i = nodes.size(); i-- > 0;) {
    const int operands = used[i] ? operand_count(nodes[i].op) : 0;
    if (operands > 0) used[nodes[i].a] = 1;
    if (operands > 1) used[nodes[i].b] = 1;
  }
  ExpressionGraph result;
  std::vector<NodeId> renamed(nodes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!used[i]) continue;
    renamed[i] = static_cast<NodeId>(result.nodes.size());
    Node n = nodes[i];
    n.a = operand_count(n.op) > 0 ? renamed[n.a] : 0;
    n.b = operand_count(n.op) > 1 ? renamed[n.b] : 0;
    result.nodes.push_back(n);
  }
  return result;
}

}  // namespace evenmesh
