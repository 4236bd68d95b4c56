#include "shape/interval_math.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace evenmesh {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest_float = std::numeric_limits<float>::max();
constexpr double pi = std::numbers::pi;
/// A float operation rounds by 2^-24 of its result, a float number in the code by as much again.
constexpr double rounding = 0x1p-22;
/// Twice the largest error of the functions in vector_math-inl.h.
constexpr double function_error = 5e-7;

constexpr Enclosure anything{-infinity, infinity, true};

/// Ends moved outward by `share` of themselves and by `distance`; ends beyond the floats become infinite.
/// Rounding is monotonic, so that zero as an end stays zero.
Enclosure widened(double lo, double hi, bool may_be_nan, double share = rounding, double distance = 0) {
  const double below = lo - (std::abs(lo) * share + distance), above = hi + (std::abs(hi) * share + distance);
  // An end that is infinite towards the inside (lo = ∞) gives ∞ − ∞ here.
  const double wide_lo = below >= -largest_float ? std::min(below, largest_float) : lo > 0 ? largest_float : -infinity;
  const double wide_hi = above <= largest_float ? std::max(above, -largest_float) : hi < 0 ? -largest_float : infinity;
  return {wide_lo, wide_hi, may_be_nan};
}

bool infinite(const Enclosure& a) {
  return a.lo == -infinity || a.hi == infinity;
}
bool has_zero(const Enclosure& a) {
  return a.lo <= 0 && a.hi >= 0;
}

Enclosure plus(const Enclosure& a, const Enclosure& b) {
  const bool opposite = (a.hi == infinity && b.lo == -infinity) || (a.lo == -infinity && b.hi == infinity);
  return widened(a.lo + b.lo, a.hi + b.hi, a.may_be_nan || b.may_be_nan || opposite);
}

Enclosure negative(const Enclosure& a) {
  return {-a.hi, -a.lo, a.may_be_nan};
}

Enclosure times(const Enclosure& a, const Enclosure& b) {
  // 0·∞ is 0 for the ends: ∞ stands for large numbers there.
  const auto product = [](double p, double q) { return p == 0 || q == 0 ? 0.0 : p * q; };
  const double c[4] = {product(a.lo, b.lo), product(a.lo, b.hi), product(a.hi, b.lo), product(a.hi, b.hi)};
  const bool undefined = (infinite(a) && has_zero(b)) || (infinite(b) && has_zero(a));
  return widened(*std::min_element(c, c + 4), *std::max_element(c, c + 4), a.may_be_nan || b.may_be_nan || undefined);
}

Enclosure magnitude(const Enclosure& a) {
  if (a.lo >= 0) return a;
  if (a.hi <= 0) return negative(a);
  return {0, std::max(-a.lo, a.hi), a.may_be_nan};
}

Enclosure squared(const Enclosure& a) {
  const Enclosure m = magnitude(a);
  return widened(m.lo * m.lo, m.hi * m.hi, m.may_be_nan);
}

Enclosure over(const Enclosure& a, const Enclosure& b) {
  if (b.lo < 0 && b.hi >= 0) return {-infinity, infinity, a.may_be_nan || b.may_be_nan || has_zero(a) || infinite(a)};
  if (b.lo == 0) {
    const bool may_be_nan = a.may_be_nan || b.may_be_nan || has_zero(a) || (infinite(a) && infinite(b));
    if (b.hi == 0 || a.lo < 0) return {-infinity, infinity, may_be_nan};
    return widened(b.hi == infinity ? 0.0 : a.lo / b.hi, infinity, may_be_nan);
  }
  if (infinite(a) && infinite(b)) return anything;
  const double c[4] = {a.lo / b.lo, a.lo / b.hi, a.hi / b.lo, a.hi / b.hi};
  return widened(*std::min_element(c, c + 4), *std::max_element(c, c + 4), a.may_be_nan || b.may_be_nan);
}

/// An increasing function with the absolute error `distance` and the relative error `share`.
template <typename F>
Enclosure increasing(const Enclosure& a, F f, double share, double distance) {
  return widened(f(a.lo), f(a.hi), a.may_be_nan, share, distance);
}

/// Operands beyond [lo, hi] give no number; the rest is kept. Empty when nothing remains.
struct Domain {
  Enclosure inside;
  bool empty;
};
Domain restricted(const Enclosure& a, double lo, double hi) {
  const bool beyond = a.lo < lo || a.hi > hi;
  return {{std::max(a.lo, lo), std::min(a.hi, hi), a.may_be_nan || beyond}, a.hi < lo || a.lo > hi};
}

/// sin, or cos with phase ½: values at the ends, ±1 where a peak lies between them.
Enclosure wave(const Enclosure& a, double phase) {
  const bool may_be_nan = a.may_be_nan || infinite(a);
  if (infinite(a) || a.hi - a.lo >= 2 * pi) return widened(-1, 1, may_be_nan, 0, function_error);
  const auto value = [&](double x) { return phase == 0 ? std::sin(x) : std::cos(x); };
  // Peaks of sin are at (2k + ½)π, troughs at (2k − ½)π; cos is sin with ½π more.
  const auto passes = [&](double offset) {
    return std::floor((a.hi / pi - offset) / 2) >= std::ceil((a.lo / pi - offset) / 2);
  };
  const double p = value(a.lo), q = value(a.hi);
  // Reduction of large arguments loses digits.
  const double distance = function_error + 0x1p-48 * std::max(std::abs(a.lo), std::abs(a.hi));
  return widened(passes(-0.5 - phase) ? -1 : std::min(p, q), passes(0.5 - phase) ? 1 : std::max(p, q), may_be_nan, 0,
                 distance);
}

Enclosure tangent(const Enclosure& a) {
  constexpr double near_pole = 1e-4;
  if (infinite(a) || a.hi - a.lo >= pi) return anything;
  if (std::floor((a.lo - near_pole) / pi + 0.5) != std::floor((a.hi + near_pole) / pi + 0.5))
    return {-infinity, infinity, a.may_be_nan};
  const double p = std::tan(a.lo), q = std::tan(a.hi);
  return widened(p - function_error * p * p, q + function_error * q * q, a.may_be_nan, 4 * function_error,
                 function_error);
}

Enclosure angle(const Enclosure& y, const Enclosure& x) {
  const bool may_be_nan = y.may_be_nan || x.may_be_nan;
  // The cut along the negative x axis, and the origin, where every angle is possible.
  if (x.lo <= 0 && has_zero(y)) return widened(-pi, pi, may_be_nan, rounding, function_error);
  const double c[4] = {std::atan2(y.lo, x.lo), std::atan2(y.lo, x.hi), std::atan2(y.hi, x.lo), std::atan2(y.hi, x.hi)};
  return widened(*std::min_element(c, c + 4), *std::max_element(c, c + 4), may_be_nan, rounding, function_error);
}

Enclosure exponential(const Enclosure& a) {
  // The float argument is off by its own rounding, at most 2^-18 before exp overflows.
  Enclosure e = increasing(
      a, [](double v) { return std::exp(v); }, 1e-6, 1e-44);
  e.lo = std::max(e.lo, 0.0);
  return e;
}

Enclosure logarithm(const Enclosure& a) {
  const Domain d = restricted(a, 0, infinity);
  if (d.empty) return anything;
  return increasing(
      d.inside, [](double v) { return std::log(v); }, function_error, function_error);
}

Enclosure raised(const Enclosure& a, const Enclosure& b) {
  const Enclosure l = logarithm(a);
  // log 0 is −∞ and 0·∞ counts as 0, so that 0^0 = 1 is among the ends.
  Enclosure product = times(b, l);
  product.may_be_nan = a.may_be_nan || b.may_be_nan || a.lo < 0;
  Enclosure result = exponential(product);
  const double loss = 1e-5 * (std::isfinite(result.hi) ? result.hi : 0.0);
  result = widened(result.lo - 1e-5 * result.lo, result.hi + loss, result.may_be_nan);
  if (has_zero(b)) {
    result.lo = std::min(result.lo, 1.0);
    result.hi = std::max(result.hi, 1.0);
  }
  return result;
}

Enclosure remainder(const Enclosure& a, const Enclosure& b) {
  if (has_zero(b) || infinite(a) || infinite(b)) return anything;
  const Enclosure quotient = over(a, b);
  const Enclosure whole{std::floor(quotient.lo), std::floor(quotient.hi), quotient.may_be_nan};
  const Enclosure rest = plus(a, negative(times(b, whole)));
  // Rounding of a/b may take the remainder a little beyond [0, b].
  const double slack =
      4 * rounding * (std::max(std::abs(a.lo), std::abs(a.hi)) + std::max(std::abs(b.lo), std::abs(b.hi)));
  return {std::max(rest.lo - slack, std::min(0.0, b.lo) - slack),
          std::min(rest.hi + slack, std::max(0.0, b.hi) + slack), rest.may_be_nan};
}

/// min(a, b) takes b where a is not a number.
Enclosure chosen(double lo, double hi, const Enclosure& a, const Enclosure& b) {
  if (a.may_be_nan) {
    lo = std::min(lo, b.lo);
    hi = std::max(hi, b.hi);
  }
  return {lo, hi, b.may_be_nan};
}

Enclosure sign_of(const Enclosure& a) {
  const bool nan = a.may_be_nan;  // the sign of NaN is 0
  return {a.lo > 0 && !nan ? 1.0 : a.lo >= 0 ? 0.0 : -1.0, a.hi < 0 && !nan ? -1.0 : a.hi <= 0 ? 0.0 : 1.0, false};
}

Enclosure inverse_function(Op op, const Enclosure& a) {
  if (op == Op::atan)
    return increasing(
        a, [](double v) { return std::atan(v); }, rounding, function_error);
  const Domain d = restricted(a, -1, 1);
  if (d.empty) return anything;
  if (op == Op::asin)
    return increasing(
        d.inside, [](double v) { return std::asin(v); }, rounding, function_error);
  return widened(std::acos(d.inside.hi), std::acos(d.inside.lo), d.inside.may_be_nan, rounding, function_error);
}

Enclosure scaled(const Enclosure& a, double s) {
  // A number in the code is rounded to float as well.
  const Enclosure p =
      s >= 0 ? Enclosure{s * a.lo, s * a.hi, a.may_be_nan} : Enclosure{s * a.hi, s * a.lo, a.may_be_nan};
  if (std::isnan(p.lo) || std::isnan(p.hi) || std::isnan(s)) return anything;
  return widened(p.lo, p.hi, p.may_be_nan);
}

Enclosure square_root(const Enclosure& a) {
  const Domain d = restricted(a, 0, infinity);
  if (d.empty) return anything;
  return increasing(
      d.inside, [](double v) { return std::sqrt(v); }, rounding, 0);
}

}  // namespace

Enclosure enclose(double lo, double hi) {
  return widened(lo, hi, false);
}

Enclosure apply(const Node& node, const Enclosure& a, const Enclosure& b) {
  switch (node.op) {
    case Op::constant:
      return std::isnan(node.s) ? anything : widened(node.s, node.s, false);
    case Op::affine:
      return plus(scaled(a, node.s), scaled({1, 1, false}, node.t));
    case Op::blend:
      return plus(scaled(a, node.s), scaled(b, node.t));
    case Op::add:
      return plus(a, b);
    case Op::sub:
      return plus(a, negative(b));
    case Op::mul:
      return times(a, b);
    case Op::square:
      return squared(a);
    case Op::div:
      return over(a, b);
    case Op::sqrt:
      return square_root(a);
    case Op::sin:
      return wave(a, 0);
    case Op::cos:
      return wave(a, 0.5);
    case Op::tan:
      return tangent(a);
    case Op::asin:
    case Op::acos:
    case Op::atan:
      return inverse_function(node.op, a);
    case Op::atan2:
      return angle(a, b);
    case Op::exp:
      return exponential(a);
    case Op::log:
      return logarithm(a);
    case Op::pow:
      return raised(a, b);
    case Op::abs:
      return magnitude(a);
    case Op::min:
      return chosen(std::min(a.lo, b.lo), std::min(a.hi, b.hi), a, b);
    case Op::max:
      return chosen(std::max(a.lo, b.lo), std::max(a.hi, b.hi), a, b);
    case Op::floor:
      return {std::floor(a.lo), std::floor(a.hi), a.may_be_nan};
    case Op::mod:
      return remainder(a, b);
    case Op::sign:
      return sign_of(a);
    case Op::x:
    case Op::y:
    case Op::z:
      break;
  }
  return anything;
}

}  // namespace evenmesh
