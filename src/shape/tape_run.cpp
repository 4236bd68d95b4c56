// The interpreter of tapes. Every operation runs over a chunk of points before the next one starts, so that choosing it
// costs little (as in Keeter, Massively parallel rendering of complex closed-form implicit surfaces, ToG 2020).

#include <algorithm>
#include <array>

#include "shape/tape.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shape/tape_run.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

#include "shape/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace evenmesh::HWY_NAMESPACE {
namespace {

/// Vectors that a loop takes at once, so that its own cost is small beside two loads and a store.
constexpr std::size_t unroll = 4;

/// dst[i] = f(a[i])
template <typename F>
HWY_INLINE void each(std::size_t n, float* dst, const float* a, F f) {
  const FloatTag d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < n; i += unroll * lanes)
    for (std::size_t k = 0; k < unroll; ++k) {
      const std::size_t j = i + k * lanes;
      hn::StoreU(f(hn::LoadU(d, a + j)), d, dst + j);
    }
}

/// dst[i] = f(a[i], b[i])
template <typename F>
HWY_INLINE void each(std::size_t n, float* dst, const float* a, const float* b, F f) {
  const FloatTag d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < n; i += unroll * lanes)
    for (std::size_t k = 0; k < unroll; ++k) {
      const std::size_t j = i + k * lanes;
      hn::StoreU(f(hn::LoadU(d, a + j), hn::LoadU(d, b + j)), d, dst + j);
    }
}

HWY_INLINE Floats lesser(Floats a, Floats b) {
  return hn::IfThenElse(hn::Lt(a, b), a, b);
}
HWY_INLINE Floats greater(Floats a, Floats b) {
  return hn::IfThenElse(hn::Gt(a, b), a, b);
}
HWY_INLINE Floats whole_quotient(Floats a, Floats b) {
  return hn::Floor(hn::Div(a, b));
}
HWY_INLINE Floats sign_of(Floats a) {
  const Floats zero = hn::Zero(FloatTag());
  const Floats positive = hn::IfThenElseZero(hn::Gt(a, zero), number(1.0f));
  return hn::IfThenElse(hn::Lt(a, zero), number(-1.0f), positive);
}

/// One operation on n values, n a multiple of `unroll` vectors.
HWY_NOINLINE void run_values(const Instruction& c, std::size_t n, float* dst, const float* a, const float* b) {
  const Floats s = number(c.s), t = number(c.t);
  switch (c.op) {
    case Op::affine:
      return each(n, dst, a, [=](Floats u) HWY_ATTR { return hn::Add(hn::Mul(s, u), t); });
    case Op::blend:
      return each(n, dst, a, b, [=](Floats u, Floats v) HWY_ATTR { return hn::Add(hn::Mul(s, u), hn::Mul(t, v)); });
    case Op::add:
      return each(n, dst, a, b, [](Floats u, Floats v) HWY_ATTR { return hn::Add(u, v); });
    case Op::sub:
      return each(n, dst, a, b, [](Floats u, Floats v) HWY_ATTR { return hn::Sub(u, v); });
    case Op::mul:
      return each(n, dst, a, b, [](Floats u, Floats v) HWY_ATTR { return hn::Mul(u, v); });
    case Op::div:
      return each(n, dst, a, b, [](Floats u, Floats v) HWY_ATTR { return hn::Div(u, v); });
    case Op::square:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return hn::Mul(u, u); });
    case Op::sqrt:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return hn::Sqrt(u); });
    case Op::abs:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return hn::Abs(u); });
    case Op::floor:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return hn::Floor(u); });
    case Op::sign:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return sign_of(u); });
    case Op::min:
      return each(n, dst, a, b, [](Floats u, Floats v) HWY_ATTR { return lesser(u, v); });
    case Op::max:
      return each(n, dst, a, b, [](Floats u, Floats v) HWY_ATTR { return greater(u, v); });
    case Op::mod:
      return each(n, dst, a, b,
                  [](Floats u, Floats v) HWY_ATTR { return hn::Sub(u, hn::Mul(v, whole_quotient(u, v))); });
    case Op::sin:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return sine(u); });
    case Op::cos:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return cosine(u); });
    case Op::tan:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return hn::Div(sine(u), cosine(u)); });
    case Op::asin:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return arc_sine(u); });
    case Op::acos:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return arc_cosine(u); });
    case Op::atan:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return arc_tangent(u); });
    case Op::atan2:
      return each(n, dst, a, b, [](Floats u, Floats v) HWY_ATTR { return arc_tangent2(u, v); });
    case Op::exp:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return exponential(u); });
    case Op::log:
      return each(n, dst, a, [](Floats u) HWY_ATTR { return logarithm(u); });
    case Op::pow:
      return each(n, dst, a, b, [](Floats u, Floats v) HWY_ATTR { return power(u, v); });
    case Op::x:
    case Op::y:
    case Op::z:
    case Op::constant:
      return;
  }
}

HWY_NOINLINE void run_atan2_factors(std::size_t n, const float* a, const float* b, float* fa, float* fb) {
  const auto over_squares = [](Floats w, Floats u, Floats v) HWY_ATTR {
    const Floats squares = hn::Add(hn::Mul(u, u), hn::Mul(v, v));
    return hn::IfThenElseZero(hn::Gt(squares, hn::Zero(FloatTag())), hn::Div(w, squares));
  };
  each(n, fa, a, b, [=](Floats u, Floats v) HWY_ATTR { return over_squares(v, u, v); });
  each(n, fb, a, b, [=](Floats u, Floats v) HWY_ATTR { return over_squares(hn::Neg(u), u, v); });
}

/// ∂op/∂a and ∂op/∂b at each point, for the operations whose factors are not numbers or operands themselves.
HWY_NOINLINE void run_factors(const Instruction& c, std::size_t n, const float* a, const float* b, float* fa,
                              float* fb) {
  const Floats one = number(1.0f), zero = hn::Zero(FloatTag());
  switch (c.op) {
    case Op::square:
      return each(n, fa, a, [](Floats u) HWY_ATTR { return hn::Add(u, u); });
    case Op::sqrt:
      return each(n, fa, a, [=](Floats u) HWY_ATTR {
        return hn::IfThenElseZero(hn::Gt(u, zero), hn::Div(number(0.5f), hn::Sqrt(u)));
      });
    case Op::sin:
      return each(n, fa, a, [](Floats u) HWY_ATTR { return cosine(u); });
    case Op::cos:
      return each(n, fa, a, [](Floats u) HWY_ATTR { return hn::Neg(sine(u)); });
    case Op::tan:
      return each(n, fa, a, [=](Floats u) HWY_ATTR {
        const Floats k = cosine(u);
        return hn::Div(one, hn::Mul(k, k));
      });
    case Op::asin:
    case Op::acos: {
      const Floats unit = number(c.op == Op::asin ? 1.0f : -1.0f);
      return each(n, fa, a, [=](Floats u) HWY_ATTR {
        const Floats leg = other_leg(u);
        return hn::IfThenElseZero(hn::Gt(leg, zero), hn::Div(unit, leg));
      });
    }
    case Op::atan:
      return each(n, fa, a, [=](Floats u) HWY_ATTR { return hn::Div(one, hn::Add(one, hn::Mul(u, u))); });
    case Op::atan2:
      return run_atan2_factors(n, a, b, fa, fb);
    case Op::exp:
      return each(n, fa, a, [](Floats u) HWY_ATTR { return exponential(u); });
    case Op::log:
      return each(n, fa, a, [=](Floats u) HWY_ATTR { return hn::IfThenElseZero(hn::Gt(u, zero), hn::Div(one, u)); });
    case Op::pow:
      each(n, fa, a, b, [=](Floats u, Floats v) HWY_ATTR {
        return hn::IfThenElseZero(hn::Gt(u, zero), hn::Mul(v, power(u, hn::Sub(v, one))));
      });
      if (c.mask_b == 0) return;
      return each(n, fb, a, b, [=](Floats u, Floats v) HWY_ATTR {
        return hn::IfThenElseZero(hn::Gt(u, zero), hn::Mul(power(u, v), logarithm(u)));
      });
    case Op::abs:
      return each(n, fa, a, [=](Floats u) HWY_ATTR { return hn::CopySign(one, u); });
    case Op::div:
      each(n, fa, b, [=](Floats v) HWY_ATTR { return hn::Div(one, v); });
      if (c.mask_b == 0) return;
      return each(n, fb, a, b, [](Floats u, Floats v) HWY_ATTR { return hn::Neg(hn::Div(hn::Div(u, v), v)); });
    case Op::mod:
      each(n, fa, a, [=](Floats) HWY_ATTR { return one; });
      return each(n, fb, a, b, [](Floats u, Floats v) HWY_ATTR { return hn::Neg(whole_quotient(u, v)); });
    case Op::min:
      return each(n, fa, a, b, [=](Floats u, Floats v) HWY_ATTR { return hn::IfThenElseZero(hn::Lt(u, v), one); });
    case Op::max:
      return each(n, fa, a, b, [=](Floats u, Floats v) HWY_ATTR { return hn::IfThenElseZero(hn::Gt(u, v), one); });
    default:
      return;
  }
}

/// Where the value and the three derivatives of a register lie.
using Planes = std::array<float*, 4>;

/// The derivative of a sum, with numbers as factors.
HWY_INLINE void chain_linear(std::size_t n, float* dst, const float* da, const float* db, float fa, float fb) {
  const Floats s = number(fa), t = number(fb);
  if (da && db) {
    if (fa == 1 && fb == 1) return each(n, dst, da, db, [](Floats u, Floats v) HWY_ATTR { return hn::Add(u, v); });
    return each(n, dst, da, db, [=](Floats u, Floats v) HWY_ATTR { return hn::Add(hn::Mul(s, u), hn::Mul(t, v)); });
  }
  const Floats factor = da ? s : t;
  each(n, dst, da ? da : db, [=](Floats u) HWY_ATTR { return hn::Mul(factor, u); });
}

/// The chain rule with a factor per point.
HWY_INLINE void chain(std::size_t n, float* dst, const float* da, const float* db, const float* fa, const float* fb) {
  const FloatTag d;
  if (!da || !db)
    return each(n, dst, da ? da : db, da ? fa : fb, [](Floats u, Floats f) HWY_ATTR { return hn::Mul(u, f); });
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const Floats p = hn::Mul(hn::LoadU(d, da + i), hn::LoadU(d, fa + i));
    hn::StoreU(hn::Add(p, hn::Mul(hn::LoadU(d, db + i), hn::LoadU(d, fb + i))), d, dst + i);
  }
}

/// The derivative of the operand taken: `taken` is 1 for a and 0 for b.
HWY_INLINE void curve_choice(std::size_t n, float* dst, const float* da, const float* db, const float* taken) {
  const FloatTag d;
  const Floats zero = hn::Zero(d);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const Floats u = da ? hn::LoadU(d, da + i) : zero, v = db ? hn::LoadU(d, db + i) : zero;
    hn::StoreU(hn::IfThenElse(hn::Gt(hn::LoadU(d, taken + i), zero), u, v), d, dst + i);
  }
}

/// One operation on values and derivatives. `factors` has room for two chunks. Every plane is read before it is
/// written, although dst may be a or b: derivatives first, axis by axis, values last.
HWY_NOINLINE void run_gradient(const Instruction& c, std::size_t n, const Planes& dst, const Planes& a, const Planes& b,
                               float* factors) {
  const std::uint8_t mask = c.op == Op::floor || c.op == Op::sign ? 0 : c.mask_a | c.mask_b;
  const float *fa = factors, *fb = factors + tape_chunk;
  if (c.op == Op::mul) {
    fa = b[0];
    fb = a[0];
  } else if (mask != 0)
    run_factors(c, n, a[0], b[0], factors, factors + tape_chunk);
  for (int axis = 0; axis < 3; ++axis) {
    if ((mask >> axis & 1) == 0) continue;
    float* to = dst[axis + 1];
    const float* da = c.mask_a >> axis & 1 ? a[axis + 1] : nullptr;
    const float* db = c.mask_b >> axis & 1 ? b[axis + 1] : nullptr;
    switch (c.op) {
      case Op::affine:
        chain_linear(n, to, da, nullptr, c.s, 0);
        break;
      case Op::blend:
        chain_linear(n, to, da, db, c.s, c.t);
        break;
      case Op::add:
        chain_linear(n, to, da, db, 1, 1);
        break;
      case Op::sub:
        chain_linear(n, to, da, db, 1, -1);
        break;
      case Op::min:
      case Op::max:
        curve_choice(n, to, da, db, fa);
        break;
      default:
        chain(n, to, da, db, fa, fb);
    }
  }
  run_values(c, n, dst[0], a[0], b[0]);
}

/// Points that the loops take at once.
std::size_t step_size() {
  return unroll * hn::Lanes(FloatTag());
}

/// All operations on up to one chunk of points, a multiple of the step. registers[r] is where register r lies.
void run_chunk(const Tape& tape, std::size_t n, float* const* registers) {
  for (const Instruction& c : tape.code) run_values(c, n, registers[c.dst], registers[c.a], registers[c.b]);
}

void run_chunk_gradient(const Tape& tape, std::size_t n, const Planes* registers, float* factors) {
  for (const Instruction& c : tape.code) run_gradient(c, n, registers[c.dst], registers[c.a], registers[c.b], factors);
}

}  // namespace
}  // namespace evenmesh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace evenmesh {
namespace {

HWY_EXPORT(step_size);
HWY_EXPORT(run_chunk);
HWY_EXPORT(run_chunk_gradient);

/// Room for `count` floats that starts on a cache line and is kept by the thread.
float* scratch(std::size_t count) {
  constexpr std::size_t line = 64 / sizeof(float);
  thread_local std::vector<float> room;
  if (room.size() < count + line) room.assign(count + line, 0.0f);
  const auto address = reinterpret_cast<std::uintptr_t>(room.data());
  return room.data() + (64 - address % 64) % 64 / sizeof(float);
}

/// n rounded up to whole steps of the kernels.
std::size_t whole_steps(std::size_t n) {
  const std::size_t step = HWY_DYNAMIC_DISPATCH(step_size)();
  return (n + step - 1) / step * step;
}

/// Copies the last points and fills up the step, so that no vector reaches beyond the caller's arrays.
void fill_up(std::span<const float> from, std::size_t padded, float* to) {
  std::copy(from.begin(), from.end(), to);
  std::fill(to + from.size(), to + padded, from.back());
}

/// Operations only read inputs and constants, but registers of both kinds stand in one table.
float* readable(const float* p) {
  return const_cast<float*>(p);
}

}  // namespace

void run_tape(const Tape& tape, const PointBatch& points, std::span<float> values) {
  float* room = scratch((tape.temporary_count + 4) * tape_chunk);
  float* padding = room + tape.temporary_count * tape_chunk;
  thread_local std::vector<float*> registers;
  registers.resize(tape.register_count());
  for (std::size_t i = 0; i < tape.constant_count; ++i) registers[3 + i] = readable(&tape.constants[i * tape_chunk]);
  for (std::size_t i = 0; i < tape.temporary_count; ++i) registers[tape.first_temporary() + i] = room + i * tape_chunk;
  const std::uint32_t result = tape.code.back().dst;
  const std::span<const float> coordinates[3] = {points.x, points.y, points.z};
  for (std::size_t begin = 0; begin < values.size(); begin += tape_chunk) {
    const std::size_t n = std::min(tape_chunk, values.size() - begin), padded = whole_steps(n);
    // The result's register is the caller's array itself.
    registers[result] = n == padded ? &values[begin] : padding + 3 * tape_chunk;
    for (int axis = 0; axis < 3; ++axis) {
      registers[axis] = readable(&coordinates[axis][begin]);
      if (n == padded) continue;
      fill_up(coordinates[axis].subspan(begin, n), padded, padding + axis * tape_chunk);
      registers[axis] = padding + axis * tape_chunk;
    }
    HWY_DYNAMIC_DISPATCH(run_chunk)(tape, padded, registers.data());
    if (n < padded) std::copy_n(registers[result], n, &values[begin]);
  }
}

void run_tape_gradient(const Tape& tape, const PointBatch& points, std::span<float> values, std::span<float> dx,
                       std::span<float> dy, std::span<float> dz) {
  using Planes = std::array<float*, 4>;
  // Temporaries of four planes, three padded inputs, two planes of factors, one of ones.
  const std::size_t temporaries = 4 * tape.temporary_count;
  float* room = scratch((temporaries + 6) * tape_chunk);
  const auto plane = [&](std::size_t i) { return room + i * tape_chunk; };
  float *factors = plane(temporaries + 3), *ones = plane(temporaries + 5);
  std::fill_n(ones, tape_chunk, 1.0f);
  thread_local std::vector<Planes> registers;
  registers.resize(tape.register_count());
  for (std::size_t i = 0; i < tape.constant_count; ++i)
    registers[3 + i] = {readable(&tape.constants[i * tape_chunk]), nullptr, nullptr, nullptr};
  for (std::size_t i = 0; i < tape.temporary_count; ++i)
    registers[tape.first_temporary() + i] = {plane(4 * i), plane(4 * i + 1), plane(4 * i + 2), plane(4 * i + 3)};
  const Planes& result = registers[tape.code.back().dst];
  const std::span<const float> coordinates[3] = {points.x, points.y, points.z};
  const std::span<float> outputs[4] = {values, dx, dy, dz};
  for (std::size_t begin = 0; begin < values.size(); begin += tape_chunk) {
    const std::size_t n = std::min(tape_chunk, values.size() - begin), padded = whole_steps(n);
    for (int axis = 0; axis < 3; ++axis) {
      registers[axis] = {readable(&coordinates[axis][begin]), ones, ones, ones};
      if (n == padded) continue;
      fill_up(coordinates[axis].subspan(begin, n), padded, plane(temporaries + axis));
      registers[axis][0] = plane(temporaries + axis);
    }
    HWY_DYNAMIC_DISPATCH(run_chunk_gradient)(tape, padded, registers.data(), factors);
    for (int k = 0; k < 4; ++k) {
      if (k > 0 && (tape.mask >> (k - 1) & 1) == 0)
        std::fill_n(&outputs[k][begin], n, 0.0f);
      else
        std::copy_n(result[k], n, &outputs[k][begin]);
    }
  }
}

}  // namespace evenmesh
#endif  // HWY_ONCE
