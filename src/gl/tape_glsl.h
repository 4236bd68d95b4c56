#pragma once
/// Tapes as text.

#include <string>

#include "shape/tape.h"

namespace evenmesh::gl {

/// `float map(vec3 p)`: the operations of the tape one by one, in its order, constants bit by bit. It needs
/// tape_math.glsl before it. On devices that round products, sums and quotients correctly, results are those of
/// run_tape(), but for denormal numbers; elsewhere they differ by some roundings. Not-a-numbers are where the CPU has
/// them.
/// Cost: O(size); some 60 bytes per operation
std::string glsl_of_tape(const Tape& tape);

/// `vec4 em_gradient(vec3 p)`: f, ∂f/∂x, ∂f/∂y, ∂f/∂z, by the rules of run_tape_gradient().
std::string glsl_of_tape_gradient(const Tape& tape);

}  // namespace evenmesh::gl
