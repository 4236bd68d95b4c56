#pragma once
/// Fractal solids: the points whose orbits stay bounded for a fixed number of steps.

#include <array>
#include <memory>

#include "shape/field.h"

namespace evenmesh {

/// Quaternion Julia set of q² + c, cut by the space of quaternions without k: q = x + y i + z j, k part of c included.
///
/// f < 0 where |q₁₆| < 2; near the surface f is about the distance to it, far away at least half of it (Hart, Sandin,
/// Kauffman, Ray tracing deterministic 3-D fractals, SIGGRAPH 1989). Gradients are numerical, over ±epsilon().
/// @param c  |c| < 1
std::shared_ptr<const Field> make_julia(const std::array<double, 4>& c);

/// Mandelbulb of White and Nylander, p ← pⁿ + p₀ in spherical coordinates (polar angle from z), n = 7 or 8, 12 steps.
/// @param degree  7 or 8
std::shared_ptr<const Field> make_mandelbulb(int degree);

}  // namespace evenmesh
