#pragma once
/// Programs as register code, evaluated for many points at once in single precision.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "shape/expression_graph.h"
#include "shape/field.h"

namespace evenmesh {

/// Points that one operation handles before the next one starts: few enough for the registers to stay in the L1 cache,
/// enough to make the choice of the operation cost nothing.
inline constexpr std::size_t tape_chunk = 512;

/// dst = op(a, b). Registers: 0…2 the coordinates, then the constants, then the temporaries.
struct Instruction {
  Op op = Op::affine;
  std::uint8_t mask_a = 0,
               mask_b = 0;  ///< coordinates that the operands depend on (bit 0 = x): others have derivative 0
  std::uint32_t dst = 0, a = 0, b = 0;
  float s = 0, t = 0;
};

struct Tape {
  std::vector<Instruction> code;
  std::vector<float> constants;  ///< each `tape_chunk` times
  std::uint32_t constant_count = 0;
  std::uint32_t temporary_count = 0;
  std::uint8_t mask = 0;  ///< coordinates that the result depends on
  std::uint32_t first_temporary() const { return 3 + constant_count; }
  std::uint32_t register_count() const { return first_temporary() + temporary_count; }
};

/// Register allocation by last use. Cost: linear in the number of nodes.
Tape compile_tape(const ExpressionGraph& graph);

/// values[i] = f(point i). Same bits on every processor and wherever a point stands (no fused operations).
void run_tape(const Tape& tape, const PointBatch& points, std::span<float> values);

/// Also the gradient, by forward-mode differentiation of the same code. Where f has a kink (abs, min, max) the
/// derivative is that of the branch taken; where it is infinite or undefined (√ at 0), 0 stands in.
void run_tape_gradient(const Tape& tape, const PointBatch& points, std::span<float> values, std::span<float> dx,
                       std::span<float> dy, std::span<float> dz);

}  // namespace evenmesh
