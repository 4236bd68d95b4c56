#include "shape/expression_field.h"

#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "shape/interval_math.h"
#include "shape/tape.h"

namespace evenmesh {
namespace {

/// A number and its derivatives along x, y and z.
struct Dual {
  double value = 0;
  Vec3 d;
};

/// Derivatives of an operation by its operands, 0 where they are infinite; the same rules as in tape_run.cpp.
struct Factors {
  double a = 0, b = 0;
};

Factors factors_of(const Node& n, double a, double b) {
  const auto over = [](double p, double q) { return q > 0 ? p / q : 0.0; };
  switch (n.op) {
    case Op::affine:
      return {n.s, 0};
    case Op::blend:
      return {n.s, n.t};
    case Op::add:
      return {1, 1};
    case Op::sub:
      return {1, -1};
    case Op::mul:
      return {b, a};
    case Op::square:
      return {2 * a, 0};
    case Op::div:
      return {1 / b, -a / b / b};
    case Op::sqrt:
      return {over(0.5, std::sqrt(a)), 0};
    case Op::sin:
      return {std::cos(a), 0};
    case Op::cos:
      return {-std::sin(a), 0};
    case Op::tan:
      return {1 / (std::cos(a) * std::cos(a)), 0};
    case Op::asin:
      return {over(1, std::sqrt((1 - a) * (1 + a))), 0};
    case Op::acos:
      return {over(-1, std::sqrt((1 - a) * (1 + a))), 0};
    case Op::atan:
      return {1 / (1 + a * a), 0};
    case Op::atan2:
      return {over(b, a * a + b * b), over(-a, a * a + b * b)};
    case Op::exp:
      return {std::exp(a), 0};
    case Op::log:
      return {over(1, a), 0};
    case Op::pow:
      return {a > 0 ? b * std::pow(a, b - 1) : 0.0, a > 0 ? std::pow(a, b) * std::log(a) : 0.0};
    case Op::abs:
      return {std::copysign(1.0, a), 0};
    case Op::min:
      return {a < b ? 1.0 : 0.0, a < b ? 0.0 : 1.0};
    case Op::max:
      return {a > b ? 1.0 : 0.0, a > b ? 0.0 : 1.0};
    case Op::mod:
      return {1, -std::floor(a / b)};
    default:
      return {};
  }
}

/// factor · derivative, but 0 where the operand does not vary, whatever the factor.
Vec3 chained(double factor, const Vec3& d) {
  const auto times = [factor](double v) { return v == 0 ? 0.0 : factor * v; };
  return {times(d.x), times(d.y), times(d.z)};
}

class GraphField final : public Field {
 public:
  explicit GraphField(ExpressionGraph graph) : graph_(std::move(graph)), tape_(compile_tape(graph_)) {}

  void evaluate(const PointBatch& points, std::span<float> values) const override { run_tape(tape_, points, values); }

  void evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx, std::span<float> dy,
                         std::span<float> dz) const override {
    run_tape_gradient(tape_, points, values, dx, dy, dz);
  }

  Interval evaluate(const Box& box) const override {
    const Enclosure& result = enclose_all(box).back();
    // Not a number counts as outside, so it must not pass for inside.
    return {result.lo, result.may_be_nan ? std::numeric_limits<double>::infinity() : result.hi};
  }

  double evaluate(const Vec3& point, Vec3* gradient) const override {
    return gradient ? value_and_gradient(point, *gradient) : value(point);
  }

  bool is_precise() const override { return true; }
  std::shared_ptr<const Field> specialized(const Box& box) const override;

  const ExpressionGraph& graph() const { return graph_; }

 private:
  const std::vector<Enclosure>& enclose_all(const Box& box) const;
  double value(const Vec3& point) const;
  double value_and_gradient(const Vec3& point, Vec3& gradient) const;

  ExpressionGraph graph_;
  Tape tape_;
};

/// Enclosures of all nodes, in the thread's own memory: valid until the next call.
const std::vector<Enclosure>& GraphField::enclose_all(const Box& box) const {
  thread_local std::vector<Enclosure> enclosures;
  enclosures.resize(graph_.nodes.size());
  for (std::size_t i = 0; i < enclosures.size(); ++i) {
    const Node& n = graph_.nodes[i];
    if (n.op <= Op::z)
      enclosures[i] = evenmesh::enclose(box.lo[static_cast<int>(n.op)], box.hi[static_cast<int>(n.op)]);
    else
      enclosures[i] = apply(n, enclosures[n.a], enclosures[n.b]);
  }
  return enclosures;
}

double GraphField::value(const Vec3& point) const {
  thread_local std::vector<double> values;
  values.resize(graph_.nodes.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Node& n = graph_.nodes[i];
    values[i] = n.op <= Op::z ? point[static_cast<int>(n.op)] : apply(n, values[n.a], values[n.b]);
  }
  return values.back();
}

double GraphField::value_and_gradient(const Vec3& point, Vec3& gradient) const {
  thread_local std::vector<Dual> duals;
  duals.resize(graph_.nodes.size());
  for (std::size_t i = 0; i < duals.size(); ++i) {
    const Node& n = graph_.nodes[i];
    if (n.op <= Op::z) {
      const int axis = static_cast<int>(n.op);
      duals[i] = {point[axis], {}};
      duals[i].d[axis] = 1;
      continue;
    }
    const int operands = operand_count(n.op);
    const Dual a = operands > 0 ? duals[n.a] : Dual{}, b = operands > 1 ? duals[n.b] : Dual{};
    const Factors f = factors_of(n, a.value, b.value);
    duals[i] = {apply(n, a.value, b.value), chained(f.a, a.d) + chained(f.b, b.d)};
  }
  gradient = duals.back().d;
  return duals.back().value;
}

/// What becomes of a node on a box: itself, or one of its operands, or the negative of its operand.
enum class Decision { keep, first, second, negative };

Decision decide(const Node& n, const Enclosure& a, const Enclosure& b) {
  const bool numbers = !a.may_be_nan && !b.may_be_nan;
  if (n.op == Op::min)
    return b.hi <= a.lo ? Decision::second : a.hi < b.lo && numbers ? Decision::first : Decision::keep;
  if (n.op == Op::max)
    return b.lo >= a.hi ? Decision::second : a.lo > b.hi && numbers ? Decision::first : Decision::keep;
  if (n.op == Op::abs) return a.lo > 0 ? Decision::first : a.hi < 0 ? Decision::negative : Decision::keep;
  return Decision::keep;
}

// As in Keeter, Massively parallel rendering of complex closed-form implicit surfaces, ToG 2020, §3.3: nodes are
// dropped but not simplified further, which would change the rounding.
std::shared_ptr<const Field> GraphField::specialized(const Box& box) const {
  const std::vector<Enclosure>& enclosures = enclose_all(box);
  ExpressionGraph shorter = graph_;
  std::vector<NodeId> stands_for(shorter.nodes.size());
  bool decided = false;
  for (NodeId i = 0; i < shorter.nodes.size(); ++i) {
    Node& n = shorter.nodes[i];
    const Decision decision = decide(n, enclosures[n.a], enclosures[n.b]);
    n.a = operand_count(n.op) > 0 ? stands_for[n.a] : 0;
    n.b = operand_count(n.op) > 1 ? stands_for[n.b] : 0;
    stands_for[i] = i;
    if (decision == Decision::first) stands_for[i] = n.a;
    if (decision == Decision::second) stands_for[i] = n.b;
    if (decision == Decision::negative) n = {Op::affine, n.a, 0, -1.0, 0.0};
    decided = decided || decision != Decision::keep;
  }
  if (!decided) return nullptr;
  const NodeId result = stands_for.back();
  shorter.nodes.resize(result + 1);
  if (operand_count(shorter.nodes[result].op) == 0) shorter.nodes.push_back({Op::affine, result, 0, 1.0, 0.0});
  ExpressionGraph used = without_unused(shorter);
  return used.nodes.size() < graph_.nodes.size() ? make_graph_field(std::move(used)) : nullptr;
}

}  // namespace

std::shared_ptr<const Field> make_graph_field(ExpressionGraph graph) {
  return std::make_shared<GraphField>(std::move(graph));
}

const ExpressionGraph* graph_of(const Field& field) {
  const auto* found = dynamic_cast<const GraphField*>(&field);
  return found ? &found->graph() : nullptr;
}

}  // namespace evenmesh
