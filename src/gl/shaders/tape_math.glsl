// Elementary functions, operation by operation as in shape/vector_math-inl.h: drivers differ in what they make of
// theirs, and in what is not a number. `precise` keeps the order of operations, and keeps them apart.
#line 1300001
const float em_infinity = uintBitsToFloat(0x7f800000u);
const float em_nan = uintBitsToFloat(0x7fc00000u);

bool em_is_nan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }
float em_copysign(float size, float sign) {
  return uintBitsToFloat((floatBitsToUint(size) & 0x7fffffffu) | (floatBitsToUint(sign) & 0x80000000u));
}
float em_abs(float x) { return uintBitsToFloat(floatBitsToUint(x) & 0x7fffffffu); }

// min and max as comparisons: what those of GLSL make of numbers that are none is open.
float em_min(float a, float b) { return a < b ? a : b; }
float em_max(float a, float b) { return a > b ? a : b; }
float em_sign(float a) { return a < 0.0 ? -1.0 : a > 0.0 ? 1.0 : 0.0; }
float em_sqrt(float a) { return em_is_nan(a) || a < 0.0 ? em_nan : sqrt(a); }

float em_floor(float a) { return em_is_nan(a) ? a : floor(a); }
float em_quotient(float a, float b) {
  precise float q = a / b;
  return em_floor(q);
}
float em_mod(float a, float b) {
  precise float r = a - b * em_quotient(a, b);
  return r;
}

float em_into_period(float x) {
  if (!(em_abs(x) > 12000.0)) return x;
  if (em_abs(x) == em_infinity) return em_nan;
  const double period = 6.283185307179586lf;
  precise double y = double(x);
  for (int i = 0; i < 3; ++i) y = y - period * roundEven(y / period);
  return clamp(float(y), -3.2, 3.2);
}

float em_subtract_multiple(float x, float k, float unit) {
  precise float r = x - k * (unit * 3.140625);
  r = r - k * (unit * 0.0009679794311523438);
  r = r - k * (unit * -3.259629011154175e-07);
  r = r - k * (unit * 1.215420125655342e-10);
  return r;
}

float em_half_period(float y, int flip) {
  precise float t = y * y;
  precise float p = -2.40753224e-08;
  p = p * t + 2.75362527e-06;
  p = p * t + -0.000198410838;
  p = p * t + 0.00833333276;
  p = p * t + -0.166666667;
  precise float s = y + (y * t) * p;
  return uintBitsToFloat(floatBitsToUint(s) ^ (uint(flip) << 31));
}

float em_sin(float x) {
  x = em_into_period(x);
  if (em_is_nan(x)) return x;
  precise float k = roundEven(x * 0.318309886);
  return em_half_period(em_subtract_multiple(x, k, 1.0), int(k));
}

float em_cos(float x) {
  x = em_into_period(x);
  if (em_is_nan(x)) return x;
  precise float k = roundEven(x * 0.318309886 - 0.5);
  return em_half_period(em_subtract_multiple(x, k + k + 1.0, 0.5), int(k) + 1);
}

float em_tan(float x) {
  precise float t = em_sin(x) / em_cos(x);
  return t;
}

float em_exp(float x) {
  if (em_is_nan(x)) return x;
  precise float c = x < -104.0 ? -104.0 : x;
  c = c > 89.0 ? 89.0 : c;
  precise float k = roundEven(c * 1.44269504);
  precise float r = (c - k * 0.693359375) - k * -0.000212194440;
  precise float p = 0.00139262681;
  p = p * r + 0.00836324667;
  p = p * r + 0.0416665541;
  p = p * r + 0.166665766;
  p = p * r + 0.5;
  precise float e = ((r * r) * p + r) + 1.0;
  int whole = int(k), halved = whole >> 1;
  precise float a = e * intBitsToFloat((halved + 127) << 23);
  precise float b = a * intBitsToFloat((whole - halved + 127) << 23);
  return b;
}

float em_log(float x) {
  if (em_is_nan(x) || x < 0.0) return em_nan;
  if (x == 0.0) return -em_infinity;
  if (x == em_infinity) return x;
  bool denormal = x < 1.17549435e-38;
  precise float scaled = denormal ? x * 8388608.0 : x;
  int bits = floatBitsToInt(scaled);
  int exponent = (bits - 0x3f3504f3) >> 23;
  precise float m = intBitsToFloat(bits - (exponent << 23));
  precise float e = float(exponent) + (denormal ? -23.0 : 0.0);
  precise float s = (m - 1.0) / (m + 1.0);
  precise float t = s * s;
  precise float p = 0.29582159;
  p = p * t + 0.399887318;
  p = p * t + 0.666666852;
  p = (s * t) * p;
  precise float rest = (s + s) + (p + e * -0.000212194440);
  precise float result = e * 0.693359375 + rest;
  return result;
}

float em_pow(float a, float b) {
  precise float exponent = b * em_log(a);
  return b == 0.0 ? 1.0 : em_exp(exponent);
}

float em_atan2(float y, float x) {
  if (em_is_nan(x) || em_is_nan(y)) return em_nan;
  float ax = em_abs(x), ay = em_abs(y);
  bool steep = ay > ax;
  float small = steep ? ax : ay, large = steep ? ay : ax;
  precise float q = small / large;
  q = large == 0.0 ? 0.0 : q;
  q = small == em_infinity ? 1.0 : q;
  precise float t = q * q;
  precise float p = -0.00238699731;
  p = p * t + 0.0135077714;
  p = p * t + -0.0358715389;
  p = p * t + 0.0625016944;
  p = p * t + -0.0865688043;
  p = p * t + 0.110337641;
  p = p * t + -0.142785687;
  p = p * t + 0.199997393;
  p = p * t + -0.333333317;
  precise float angle = q + (q * t) * p;
  angle = steep ? 1.57079633 - angle : angle;
  angle = (floatBitsToUint(x) & 0x80000000u) != 0u ? 3.14159265 - angle : angle;
  return em_copysign(angle, y);
}

float em_atan(float x) { return em_atan2(x, 1.0); }
float em_other_leg(float x) {
  precise float square = (1.0 - x) * (1.0 + x);
  return em_sqrt(square);
}
float em_asin(float x) { return em_abs(x) <= 1.0 ? em_atan2(x, em_other_leg(x)) : em_nan; }
float em_acos(float x) { return em_abs(x) <= 1.0 ? em_atan2(em_other_leg(x), x) : em_nan; }

// Derivatives, 0 where they are infinite; the same rules as in shape/tape_run.cpp.
float em_over(float p, float q) {
  precise float ratio = p / q;
  return q > 0.0 ? ratio : 0.0;
}
float em_tan_factor(float a) {
  precise float k = em_cos(a);
  precise float f = 1.0 / (k * k);
  return f;
}
float em_atan_factor(float a) {
  precise float f = 1.0 / (1.0 + a * a);
  return f;
}
float em_atan2_factor(float w, float a, float b) {
  precise float squares = a * a + b * b;
  return em_over(w, squares);
}
float em_pow_factor_a(float a, float b) {
  precise float f = b * em_pow(a, b - 1.0);
  return a > 0.0 ? f : 0.0;
}
float em_pow_factor_b(float a, float b) {
  precise float f = em_pow(a, b) * em_log(a);
  return a > 0.0 ? f : 0.0;
}
