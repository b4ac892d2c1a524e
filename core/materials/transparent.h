#pragma once

#include "core/materials/rough.h"

namespace orrery {

// Surface that transmits light without refraction: the ray goes on in its direction. I1 is the light of the
// surface itself, as of `rough`, and I2 the light from behind. Interpolated transparency is
// (1 - kt) I1 + kt I2, where the factor 1 - kt applies to the ambient and diffuse terms of I1 but not to the
// highlight. Filtered transparency is I1 + kt Ct I2, with a colour Ct; it may create energy (Foley, van Dam,
// Feiner, Hughes, "Computer Graphics: Principles and Practice", 2nd edition, 1990, section 16.5.1).
template <class N>
struct Transparent {
  Rough<N> front;         // ambient and diffuse terms contain the factor 1 - kt if interpolated
  Vec3<N> transmittance;  // kt, or kt Ct
  // Probabilities of sampling the transmitted ray, with Lobes::all and with Lobes::non_diffuse.
  N through, through_non_diffuse;

  static Transparent<double> read(Params& p);
  MaterialTraits traits() const {
    MaterialTraits all = front.traits();
    if (transmittance == Vec3<N>(N(0))) return all;
    all.mirrors = all.transmits = all.glossy = all.non_diffuse = all.straight = true;
    return all;
  }
  RoundingLimit rounding() const { return front.rounding(); }
  double max_albedo() const { return max_component(limits().albedo); }
  ReflectionLimits limits() const {
    ReflectionLimits all = front.limits();
    all.albedo = all.albedo + transmittance;
    all.transmitted = transmittance;
    return all;
  }

  N chance(Lobes lobes) const {
    if (lobes == Lobes::all) return through;
    return with_non_diffuse(lobes) ? through_non_diffuse : N(ScalarOf<N>(0));
  }
};

}  // namespace orrery
