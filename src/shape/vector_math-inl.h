/// Elementary functions of float vectors with the same bits on every target: no fused multiply-add, no approximate
/// reciprocals. Polynomials were fitted at Chebyshev nodes; absolute or relative errors are about 1e-7.
/// Included once per target by files that use Highway's foreach_target.h; hence no #pragma once.

#if defined(EVENMESH_VECTOR_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EVENMESH_VECTOR_MATH_INL_H_
#undef EVENMESH_VECTOR_MATH_INL_H_
#else
#define EVENMESH_VECTOR_MATH_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>
#include <limits>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace evenmesh::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using IntTag = hn::RebindToSigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;

HWY_INLINE Floats number(float value) {
  return hn::Set(FloatTag(), value);
}

/// c0 + c1 t + …, in Horner's form.
HWY_INLINE Floats polynomial(Floats, float c0) {
  return number(c0);
}
template <typename... Rest>
HWY_INLINE Floats polynomial(Floats t, float c0, Rest... rest) {
  return hn::Add(hn::Mul(polynomial(t, rest...), t), number(c0));
}

/// Brings arguments beyond the exact range of the reduction into one period; infinities become NaN.
HWY_INLINE Floats into_period(Floats x) {
  const FloatTag d;
  const auto large = hn::Gt(hn::Abs(x), number(12000.0f));
  if (HWY_LIKELY(hn::AllFalse(d, large))) return x;
  HWY_ALIGN float lanes[hn::MaxLanes(FloatTag())];
  hn::Store(x, d, lanes);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i)
    if (std::abs(lanes[i]) > 12000.0f)
      lanes[i] = static_cast<float>(std::remainder(static_cast<double>(lanes[i]), 2 * std::numbers::pi));
  return hn::Load(d, lanes);
}

/// x − k·part·…: π or π/2 in parts of 11 bits, so that the first products are exact (Cody and Waite, Software Manual
/// for the Elementary Functions, 1980, ch. 8).
HWY_INLINE Floats subtract_multiple(Floats x, Floats k, float unit) {
  x = hn::Sub(x, hn::Mul(k, number(unit * 3.140625f)));
  x = hn::Sub(x, hn::Mul(k, number(unit * 0x1.fb8p-11f)));
  x = hn::Sub(x, hn::Mul(k, number(unit * -0x1.5ep-22f)));
  return hn::Sub(x, hn::Mul(k, number(unit * 0x1.0b4612p-33f)));
}

/// sin y for |y| ≤ π/2, with its sign turned where `flip` is odd.
HWY_INLINE Floats sine_of_half_period(Floats y, hn::Vec<IntTag> flip) {
  const FloatTag d;
  const Floats t = hn::Mul(y, y);
  const Floats p = polynomial(t, -0.166666667f, 0.00833333276f, -0.000198410838f, 2.75362527e-06f, -2.40753224e-08f);
  const Floats sine = hn::Add(y, hn::Mul(hn::Mul(y, t), p));
  return hn::Xor(sine, hn::BitCast(d, hn::ShiftLeft<31>(flip)));
}

HWY_INLINE Floats sine(Floats x) {
  x = into_period(x);
  const Floats k = hn::Round(hn::Mul(x, number(0.318309886f)));
  return sine_of_half_period(subtract_multiple(x, k, 1.0f), hn::ConvertTo(IntTag(), k));
}

HWY_INLINE Floats cosine(Floats x) {
  x = into_period(x);
  // x = (k + 1/2) π + y, and cos x = −(−1)^k sin y.
  const Floats k = hn::Round(hn::Sub(hn::Mul(x, number(0.318309886f)), number(0.5f)));
  const Floats odd = hn::Add(hn::Add(k, k), number(1.0f));
  const auto flip = hn::Add(hn::ConvertTo(IntTag(), k), hn::Set(IntTag(), 1));
  return sine_of_half_period(subtract_multiple(x, odd, 0.5f), flip);
}

HWY_INLINE Floats exponential(Floats x) {
  const FloatTag d;
  const IntTag di;
  const Floats low = number(-104.0f), high = number(89.0f);
  Floats c = hn::IfThenElse(hn::Lt(x, low), low, x);
  c = hn::IfThenElse(hn::Gt(c, high), high, c);
  const Floats k = hn::Round(hn::Mul(c, number(1.44269504f)));
  // ln 2 in a part of 11 bits and the rest.
  const Floats r = hn::Sub(hn::Sub(c, hn::Mul(k, number(0.693359375f))), hn::Mul(k, number(-0.000212194440f)));
  const Floats p = polynomial(r, 0.5f, 0.166665766f, 0.0416665541f, 0.00836324667f, 0.00139262681f);
  const Floats e = hn::Add(hn::Add(hn::Mul(hn::Mul(r, r), p), r), number(1.0f));
  // Scaled in two steps: 2^k itself may not be a float.
  const auto whole = hn::ConvertTo(di, k), half = hn::ShiftRight<1>(whole), bias = hn::Set(di, 127);
  const Floats scale_a = hn::BitCast(d, hn::ShiftLeft<23>(hn::Add(half, bias)));
  const Floats scale_b = hn::BitCast(d, hn::ShiftLeft<23>(hn::Add(hn::Sub(whole, half), bias)));
  return hn::IfThenElse(hn::Eq(x, x), hn::Mul(hn::Mul(e, scale_a), scale_b), x);
}

HWY_INLINE Floats logarithm(Floats x) {
  const FloatTag d;
  const IntTag di;
  const Floats zero = hn::Zero(d), infinity = number(std::numeric_limits<float>::infinity());
  const auto denormal = hn::Lt(x, number(std::numeric_limits<float>::min()));
  const Floats scaled = hn::IfThenElse(denormal, hn::Mul(x, number(0x1p23f)), x);
  const auto bits = hn::BitCast(di, scaled);
  const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3f3504f3)));  // the bits of √½
  const Floats m = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
  const Floats e = hn::Add(hn::ConvertTo(d, exponent), hn::IfThenElse(denormal, number(-23.0f), zero));
  // log m = 2 artanh s with s = (m − 1)/(m + 1).
  const Floats s = hn::Div(hn::Sub(m, number(1.0f)), hn::Add(m, number(1.0f))), t = hn::Mul(s, s);
  const Floats p = hn::Mul(hn::Mul(s, t), polynomial(t, 0.666666852f, 0.399887318f, 0.29582159f));
  const Floats rest = hn::Add(hn::Add(s, s), hn::Add(p, hn::Mul(e, number(-0.000212194440f))));
  Floats result = hn::Add(hn::Mul(e, number(0.693359375f)), rest);
  result = hn::IfThenElse(hn::Lt(x, infinity), result, x);  // infinity and NaN stay what they are
  result = hn::IfThenElse(hn::Eq(x, zero), hn::Neg(infinity), result);
  return hn::IfThenElse(hn::Lt(x, zero), number(std::numeric_limits<float>::quiet_NaN()), result);
}

/// Angle of (x, y) in (−π, π]; 0 or π at the origin.
HWY_INLINE Floats arc_tangent2(Floats y, Floats x) {
  const FloatTag d;
  const Floats ax = hn::Abs(x), ay = hn::Abs(y), zero = hn::Zero(d);
  const auto steep = hn::Gt(ay, ax);
  const Floats small = hn::IfThenElse(steep, ax, ay), large = hn::IfThenElse(steep, ay, ax);
  Floats q = hn::IfThenElse(hn::Eq(large, zero), zero, hn::Div(small, large));
  q = hn::IfThenElse(hn::Eq(small, number(std::numeric_limits<float>::infinity())), number(1.0f), q);
  const Floats t = hn::Mul(q, q);
  const Floats p = polynomial(t, -0.333333317f, 0.199997393f, -0.142785687f, 0.110337641f, -0.0865688043f,
                              0.0625016944f, -0.0358715389f, 0.0135077714f, -0.00238699731f);
  Floats angle = hn::Add(q, hn::Mul(hn::Mul(q, t), p));
  angle = hn::IfThenElse(steep, hn::Sub(number(1.57079633f), angle), angle);
  angle = hn::IfThenElse(hn::Lt(hn::CopySign(number(1.0f), x), zero), hn::Sub(number(3.14159265f), angle), angle);
  return hn::CopySign(angle, y);
}

HWY_INLINE Floats arc_tangent(Floats x) {
  return arc_tangent2(x, number(1.0f));
}

/// √(1 − x²), not a number where |x| > 1.
HWY_INLINE Floats other_leg(Floats x) {
  return hn::Sqrt(hn::Mul(hn::Sub(number(1.0f), x), hn::Add(number(1.0f), x)));
}

HWY_INLINE Floats within_unit(Floats x, Floats angle) {
  return hn::IfThenElse(hn::Le(hn::Abs(x), number(1.0f)), angle, number(std::numeric_limits<float>::quiet_NaN()));
}
HWY_INLINE Floats arc_sine(Floats x) {
  return within_unit(x, arc_tangent2(x, other_leg(x)));
}
HWY_INLINE Floats arc_cosine(Floats x) {
  return within_unit(x, arc_tangent2(other_leg(x), x));
}

/// a^b = exp(b·log a); relative error about 1e-7 · (1 + |b·log a|).
HWY_INLINE Floats power(Floats a, Floats b) {
  const Floats result = exponential(hn::Mul(b, logarithm(a)));
  return hn::IfThenElse(hn::Eq(b, hn::Zero(FloatTag())), number(1.0f), result);
}

}  // namespace
}  // namespace evenmesh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggle
