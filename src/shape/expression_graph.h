#pragma once
/// Expressions as straight-line programs: every value computed once, simplified while it is built.

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace evenmesh {

/// What a node computes from its operands a and b and the numbers s and t.
enum class Op : std::uint8_t {
  x,
  y,
  z,
  constant,  ///< s
  affine,    ///< s·a + t
  blend,     ///< s·a + t·b
  add,
  sub,
  mul,
  square,
  div,
  sqrt,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,
  exp,
  log,
  pow,  ///< exp(b·log a), 1 where b = 0; not a number where a < 0
  abs,
  min,  ///< a < b ? a : b
  max,  ///< a > b ? a : b
  floor,
  mod,   ///< a − b·⌊a/b⌋
  sign,  ///< −1, 0 or 1
};

using NodeId = std::uint32_t;

struct Node {
  Op op = Op::constant;
  NodeId a = 0, b = 0;  ///< operands, earlier nodes; unused ones are 0
  double s = 0, t = 0;
};

/// Number of operands of an operation: 0, 1 or 2.
int operand_count(Op op);

/// Nodes in an order in which operands come first; the last one is the result.
struct ExpressionGraph {
  std::vector<Node> nodes;
};

/// Builds programs: shares equal subexpressions, folds constants, gathers constant factors and offsets, and turns
/// powers into products. Simplification may change the rounding of the result, nothing else (up to 0·∞ and x − x at
/// NaN).
class GraphBuilder {
 public:
  GraphBuilder();

  NodeId constant(double value);
  NodeId coordinate(int axis) const { return static_cast<NodeId>(axis); }
  NodeId radius();  ///< √(x² + y² + z²)
  NodeId add(NodeId a, NodeId b) { return combine(a, b, 1.0); }
  NodeId sub(NodeId a, NodeId b) { return combine(a, b, -1.0); }
  NodeId negate(NodeId a) { return affine(a, -1.0, 0.0); }
  NodeId mul(NodeId a, NodeId b);
  NodeId div(NodeId a, NodeId b);
  NodeId pow(NodeId a, NodeId b);
  NodeId function(Op op, NodeId a);            ///< any function of one operand
  NodeId function(Op op, NodeId a, NodeId b);  ///< atan2, min, max, mod

  /// The nodes that `result` needs. The last one is never a bare coordinate or constant.
  ExpressionGraph finish(NodeId result) const;

 private:
  struct Key {
    Op op;
    NodeId a, b;
    std::uint64_t s, t;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };
  /// A node seen as scale · base + offset; a constant has scale 0.
  struct Linear {
    double scale, offset;
    NodeId base;
  };

  NodeId node(Op op, NodeId a = 0, NodeId b = 0, double s = 0, double t = 0);
  NodeId affine(NodeId a, double scale, double offset);
  NodeId combine(NodeId a, NodeId b, double sign);
  NodeId square(NodeId a);
  NodeId power(NodeId a, std::uint32_t exponent);
  Linear linear(NodeId a) const;
  bool is_constant(NodeId a) const { return nodes_[a].op == Op::constant; }
  bool nonnegative(NodeId a) const;

  std::vector<Node> nodes_;
  std::unordered_map<Key, NodeId, KeyHash> known_;
};

/// The program without nodes that the last one does not need.
ExpressionGraph without_unused(const ExpressionGraph& graph);

/// One operation on numbers, as the nodes define it.
double apply(const Node& node, double a, double b);

}  // namespace evenmesh
