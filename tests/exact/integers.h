#pragma once

#include <gmpxx.h>

#include <cmath>

// Exact arithmetic for the oracle: integers of any length, vectors of them, and numbers (p + s sqrt(d)) / q.
namespace orrery::exact {

using Integer = mpz_class;

// Number of fraction bits of irrational factors (unit directions, sines). Such factors are stored as integers
// in units of 2^-kFractionBits.
inline constexpr unsigned kFractionBits = 256;
inline const Integer kOne = Integer(1) << kFractionBits;

// Returns `x` in units of 2^-shift. Requires that the result is an integer, as it is for every double if
// `shift` is large enough.
inline Integer in_units(double x, int shift) {
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  Integer result(std::ldexp(mantissa, 53));
  const int left = exponent - 53 + shift;
  if (left >= 0) return result << static_cast<unsigned>(left);
  return result >> static_cast<unsigned>(-left);
}

// Returns the smallest shift for which in_units() is exact.
inline int bits_below_one(double x) {
  if (x == 0) return 0;
  int exponent = 0;
  const Integer mantissa(std::ldexp(std::frexp(x, &exponent), 53));
  return std::max(0, 53 - exponent - static_cast<int>(mpz_scan1(mantissa.get_mpz_t(), 0)));
}

struct IVec {
  Integer x, y, z;

  const Integer& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  friend IVec operator+(const IVec& a, const IVec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend IVec operator-(const IVec& a, const IVec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend IVec operator*(const IVec& a, const Integer& k) { return {a.x * k, a.y * k, a.z * k}; }
};
inline Integer dot(const IVec& a, const IVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline IVec cross(const IVec& a, const IVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
// Returns the length of `v`, rounded down, in 2^-kFractionBits times the unit of `v`.
inline Integer length(const IVec& v) { return sqrt(Integer(dot(v, v) << (2 * kFractionBits))); }

// Returns the sign of a + b sqrt(d). Requires d >= 0.
inline int sign_of(const Integer& a, const Integer& b, const Integer& d) {
  const int of_a = sgn(a), of_b = sgn(d) == 0 ? 0 : sgn(b);
  if (of_a * of_b >= 0) return of_a != 0 ? of_a : of_b;
  return of_a * sgn(Integer(a * a - b * b * d));
}

// (p + s sqrt(d)) / q, a distance along a ray. s is -1, 0 or 1; d >= 0; q > 0.
struct Root {
  Integer p;
  int s = 0;
  Integer d;
  Integer q = 1;

  static Root ratio(const Integer& p, const Integer& q) {
    return sgn(q) < 0 ? Root{-p, 0, 0, -q} : Root{p, 0, 0, q};
  }
  // Returns the sign of u + v times this root.
  int sign_of_line(const Integer& u, const Integer& v) const { return sign_of(u * q + v * p, v * s, d); }
  int sign() const { return sign_of(p, s, d); }
};

// Returns the sign of a - b.
inline int compare(const Root& a, const Root& b) {
  // a - b has the sign of x + y, where x = i + j sqrt(a.d) and y = k sqrt(b.d).
  const Integer i = a.p * b.q - b.p * a.q, j = a.s * b.q, k = -b.s * a.q;
  const int of_x = sign_of(i, j, a.d), of_y = sgn(b.d) == 0 ? 0 : sgn(k);
  if (of_x * of_y >= 0) return of_x != 0 ? of_x : of_y;
  return of_x * sign_of(i * i + j * j * a.d - k * k * b.d, 2 * i * j, a.d);
}

}  // namespace orrery::exact
