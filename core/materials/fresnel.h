#pragma once

#include "core/math/lanes.h"

// Fresnel reflectances of smooth surfaces for unpolarised light. Each cosine is the cosine of an angle to the
// normal, in [0, 1].
namespace orrery {

// Returns Schlick's approximation F0 + (1 - F0) (1 - cos)^5. REQUIRES: `cosine` belongs to the direction in
// the optically thinner medium.
template <class N>
[[gnu::always_inline]] inline N fresnel_schlick(const N& f0, const N& cosine) {
  const N x = N(ScalarOf<N>(1)) - cosine;
  const N x2 = x * x;
  return f0 + (ScalarOf<N>(1) - f0) * (x2 * x2 * x);
}

// Returns the reflectance between two dielectrics. `eta` is the index of refraction on the incident side
// divided by the index on the transmitted side.
template <class N>
[[gnu::always_inline]] inline N fresnel_dielectric(const N& eta, const N& cos_incident,
                                                   const N& cos_transmitted) {
  const N s = (eta * cos_incident - cos_transmitted) / (eta * cos_incident + cos_transmitted);
  const N p = (cos_incident - eta * cos_transmitted) / (cos_incident + eta * cos_transmitted);
  return (s * s + p * p) * ScalarOf<N>(0.5);
}

// Reflectance and cosine of the transmitted direction, computed from the cosine of the incident direction.
// Beyond the critical angle, the reflectance is 1 and cos_transmitted is 0.
template <class N>
struct DielectricSplit {
  N reflectance, cos_transmitted;
};
template <class N>
[[gnu::always_inline]] inline DielectricSplit<N> split_dielectric(const N& eta, const N& cos_incident) {
  using T = ScalarOf<N>;
  using std::sqrt;
  const N zero(T(0)), one(T(1));
  const N cos2 = one - eta * eta * (one - cos_incident * cos_incident);
  const auto total = !(cos2 > zero);
  const N cos_transmitted = sqrt(select(total, zero, cos2));
  const N reflectance = fresnel_dielectric(eta, cos_incident, cos_transmitted);
  return {select(total, one, reflectance), cos_transmitted};
}

// Returns the cosine-weighted mean reflectance over the hemisphere: the integral of 2 mu F(mu) over [0, 1].
inline double mean_dielectric(double eta) {
  constexpr int kSteps = 4096;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double mu = (i + 0.5) / kSteps;
    sum += 2 * mu * split_dielectric(eta, mu).reflectance / kSteps;
  }
  return sum;
}

// Returns the reflectance of a metal in air, with index of refraction n and extinction coefficient k.
template <class N>
[[gnu::always_inline]] inline N fresnel_conductor(const N& n, const N& k, const N& cosine) {
  using T = ScalarOf<N>;
  using std::sqrt;
  const N c2 = cosine * cosine, s2 = max_first(N(T(0)), N(T(1) - c2));
  const N d = n * n - k * k - s2;
  const N a2b2 = sqrt(d * d + T(4) * n * n * k * k);
  const N a = sqrt(max_first(N(T(0)), N((a2b2 + d) * T(0.5))));
  const N ac = T(2) * a * cosine;
  const N s = (a2b2 + c2 - ac) / (a2b2 + c2 + ac);
  const N ratio = (a2b2 * c2 + s2 * s2 - ac * s2) / (a2b2 * c2 + s2 * s2 + ac * s2);
  return (s + s * ratio) * T(0.5);
}

// Returns the reflectance along the normal, F0: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
template <class N>
[[gnu::always_inline]] inline N normal_reflectance(const N& n, const N& k) {
  using T = ScalarOf<N>;
  return ((n - T(1)) * (n - T(1)) + k * k) / ((n + T(1)) * (n + T(1)) + k * k);
}

}  // namespace orrery
