#include "shape/tape.h"

#include <algorithm>

namespace evenmesh {
namespace {

constexpr std::uint32_t never = 0xffffffffu;

/// Index of the node that uses each node last.
std::vector<std::uint32_t> last_uses(const std::vector<Node>& nodes) {
  std::vector<std::uint32_t> last(nodes.size(), never);
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    const int operands = operand_count(nodes[i].op);
    if (operands > 0) last[nodes[i].a] = i;
    if (operands > 1) last[nodes[i].b] = i;
  }
  return last;
}

std::uint8_t mask_of_result(const Instruction& instruction) {
  if (instruction.op == Op::floor || instruction.op == Op::sign) return 0;
  // The derivative of a mod b by b is a step function, which is kept.
  return instruction.mask_a | instruction.mask_b;
}

}  // namespace

Tape compile_tape(const ExpressionGraph& graph) {
  const std::vector<Node>& nodes = graph.nodes;
  const std::vector<std::uint32_t> last = last_uses(nodes);
  Tape tape;
  std::vector<std::uint32_t> place(nodes.size(), 0), unused;
  std::vector<std::uint8_t> mask(nodes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].op != Op::constant) continue;
    place[i] = 3 + tape.constant_count++;
    tape.constants.insert(tape.constants.end(), tape_chunk, static_cast<float>(nodes[i].s));
  }
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    const Node& n = nodes[i];
    const int operands = operand_count(n.op);
    if (operands == 0) {
      if (n.op == Op::constant) continue;
      place[i] = n.op == Op::x ? 0 : n.op == Op::y ? 1 : 2;
      mask[i] = static_cast<std::uint8_t>(1u << place[i]);
      continue;
    }
    Instruction code{n.op, mask[n.a], operands > 1 ? mask[n.b] : std::uint8_t{0}, 0, place[n.a], 0, 0, 0};
    code.b = operands > 1 ? place[n.b] : code.a;
    code.s = static_cast<float>(n.s);
    code.t = static_cast<float>(n.t);
    // An operand that dies here gives its register to the result: kernels read before they write.
    const auto release = [&](NodeId operand) {
      if (last[operand] == i && place[operand] >= tape.first_temporary()) unused.push_back(place[operand]);
    };
    release(n.a);
    if (operands > 1 && n.b != n.a) release(n.b);
    if (unused.empty()) unused.push_back(tape.first_temporary() + tape.temporary_count++);
    place[i] = code.dst = unused.back();
    unused.pop_back();
    mask[i] = mask_of_result(code);
    tape.code.push_back(code);
  }
  tape.mask = mask.back();
  return tape;
}

}  // namespace evenmesh
