#pragma once

#include <cmath>

namespace orrery {

// Returns the reflectance of unpolarised light between dielectrics by the textbook formula (Born, Wolf,
// "Principles of Optics", 1.5.2), in long double. `cosine` is that of the angle of incidence. `eta` is the
// refractive index on the incident side over that on the other side. Returns 1 beyond the critical angle.
inline double textbook_fresnel(long double eta, long double cosine) {
  const long double sine2 = eta * eta * (1 - cosine * cosine);
  if (sine2 >= 1) return 1;
  const long double behind = std::sqrt(1 - sine2);
  const long double s = (eta * cosine - behind) / (eta * cosine + behind);
  const long double p = (cosine - eta * behind) / (cosine + eta * behind);
  return static_cast<double>((s * s + p * p) / 2);
}

}  // namespace orrery
