// Based on: Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997.
#include "geometry/predicates.h"

#include <cmath>

namespace evenmesh {
namespace {

/// A number as an unevaluated sum of doubles that do not overlap, smallest first, without zeros.
template <int Capacity>
struct Expansion {
  double part[Capacity];
  int size = 0;

  void append(double x) {
    if (x != 0) part[size++] = x;
  }
  int sign() const { return size == 0 ? 0 : part[size - 1] > 0 ? 1 : -1; }
};

struct Sum {
  double value, error;
};

/// value + error = a + b exactly (Knuth; Shewchuk §2.2, Theorem 7).
Sum exact_sum(double a, double b) {
  const double x = a + b, b_virtual = x - a, a_virtual = x - b_virtual;
  return {x, (a - a_virtual) + (b - b_virtual)};
}

/// The same when |a| ≥ |b| (Dekker; Theorem 6).
Sum exact_sum_ordered(double a, double b) {
  const double x = a + b;
  return {x, b - (x - a)};
}

/// The upper and lower half of the bits of a number (Dekker; Theorem 17).
Sum split(double a) {
  const double c = 0x1.0000002p27 * a, high = c - (c - a);
  return {high, a - high};
}

/// value + error = a · b exactly (Dekker, Veltkamp; Theorem 18).
Sum exact_product(double a, double b) {
  const double x = a * b;
  const auto [a_high, a_low] = split(a);
  const auto [b_high, b_low] = split(b);
  return {x, a_low * b_low - (((x - a_high * b_high) - a_low * b_high) - a_high * b_low)};
}

Expansion<2> difference(double a, double b) {
  const Sum s = exact_sum(a, -b);
  Expansion<2> e;
  e.append(s.error);
  e.append(s.value);
  return e;
}

/// Fast expansion sum (Theorem 13) that leaves zeros out.
template <int M, int N>
Expansion<M + N> operator+(const Expansion<M>& e, const Expansion<N>& f) {
  Expansion<M + N> h;
  int i = 0, j = 0;
  const auto next = [&] {
    return j == f.size || (i < e.size && std::abs(e.part[i]) < std::abs(f.part[j])) ? e.part[i++] : f.part[j++];
  };
  if (e.size + f.size == 0) return h;
  double q = next();
  for (int k = 1; k < e.size + f.size; ++k) {
    const Sum s = exact_sum(q, next());
    h.append(s.error);
    q = s.value;
  }
  h.append(q);
  return h;
}

/// Scale expansion (Theorem 19) that leaves zeros out.
template <int N>
Expansion<2 * N> operator*(const Expansion<N>& e, double b) {
  Expansion<2 * N> h;
  if (e.size == 0) return h;
  Sum q = exact_product(e.part[0], b);
  h.append(q.error);
  for (int i = 1; i < e.size; ++i) {
    const Sum t = exact_product(e.part[i], b);
    const Sum low = exact_sum(q.value, t.error);
    h.append(low.error);
    q = exact_sum_ordered(t.value, low.value);
    h.append(q.error);
  }
  h.append(q.value);
  return h;
}

template <int N>
Expansion<4 * N> operator*(const Expansion<N>& e, const Expansion<2>& f) {
  const Expansion<2 * N> none{};
  return (f.size > 0 ? e * f.part[0] : none) + (f.size > 1 ? e * f.part[1] : none);
}

template <int N>
Expansion<N> operator-(Expansion<N> e) {
  for (int i = 0; i < e.size; ++i) e.part[i] = -e.part[i];
  return e;
}

/// a·d − b·c
Expansion<16> determinant(const Expansion<2>& a, const Expansion<2>& b, const Expansion<2>& c, const Expansion<2>& d) {
  return a * d + -(b * c);
}

}  // namespace

int detail::orient2d_exact(const Point2& a, const Point2& b, const Point2& c) {
  return determinant(difference(b.x, a.x), difference(b.y, a.y), difference(c.x, a.x), difference(c.y, a.y)).sign();
}

int detail::orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Expansion<2> bx = difference(b.x, a.x), by = difference(b.y, a.y), bz = difference(b.z, a.z);
  const Expansion<2> cx = difference(c.x, a.x), cy = difference(c.y, a.y), cz = difference(c.z, a.z);
  const auto x = determinant(by, bz, cy, cz) * difference(d.x, a.x);
  const auto y = determinant(bz, bx, cz, cx) * difference(d.y, a.y);
  const auto z = determinant(bx, by, cx, cy) * difference(d.z, a.z);
  return (x + y + z).sign();
}

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis)
    if (orient2d(drop_axis(a, axis), drop_axis(b, axis), drop_axis(c, axis)) != 0) return false;
  return true;
}

}  // namespace evenmesh
