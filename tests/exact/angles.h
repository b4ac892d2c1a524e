#pragma once

#include "tests/exact/integers.h"

namespace orrery::exact {

// Cosine and sine of an angle, in units of 2^-kFractionBits. Exact at multiples of a right angle, otherwise
// accurate to a few of these units.
struct ExactRotation {
  Integer cosine, sine;
};

// Returns pi in units of 2^-kFractionBits, by Machin's formula: pi / 4 = 4 atan(1/5) - atan(1/239).
inline Integer pi() {
  const auto arctangent = [](unsigned over) {
    Integer power = kOne / over, sum = power;
    for (unsigned n = 3; power != 0; n += 2) {
      power /= over * over;
      const Integer term = power / n;
      sum += (n / 2) % 2 == 1 ? Integer(-term) : term;
    }
    return sum;
  };
  return 4 * (4 * arctangent(5) - arctangent(239));
}

inline ExactRotation turn(double degrees) {
  const int shift = bits_below_one(degrees);
  const Integer unit = Integer(1) << static_cast<unsigned>(shift);
  const Integer angle = in_units(degrees, shift), right = 90 * unit;
  Integer quarter, rest;  // rest in [0, 90) degrees
  mpz_fdiv_qr(quarter.get_mpz_t(), rest.get_mpz_t(), angle.get_mpz_t(), right.get_mpz_t());
  const Integer x = pi() * rest / (180 * unit);
  Integer cosine = kOne, sine = x, term = kOne;
  if (rest != 0) {
    term = x;
    cosine = kOne;
    for (unsigned n = 2; term != 0; ++n) {
      term = term * x / kOne / n;
      Integer& into = n % 2 == 0 ? cosine : sine;
      into += (n / 2) % 2 == 1 ? Integer(-term) : term;
    }
  }
  switch (Integer(((quarter % 4) + 4) % 4).get_si()) {
    case 0: return {cosine, sine};
    case 1: return {-sine, cosine};
    case 2: return {-cosine, -sine};
    default: return {sine, -cosine};
  }
}

}  // namespace orrery::exact
