#pragma once

#include "core/materials/glass.h"

namespace orrery {

template <class N>
struct SubsurfaceInputs;

// Glass around a medium that scatters and absorbs light: wax, marble, skin, milk, fog. Light travels a mean
// free path between two events. At an event, the fraction `albedo` is scattered by the phase function of
// Henyey and Greenstein ("Diffuse radiation in the galaxy", Astrophysical Journal 93, 1941), whose mean
// cosine is `anisotropy`. The rest is absorbed. RandomWalk follows the events in closed bodies. Open
// surfaces, and techniques without interreflection, only attenuate light: without an albedo the result is the
// filter of Beer and Lambert.
template <class N>
struct Subsurface : Glass<N> {
  Vec3<N> albedo;
  N anisotropy;

  template <class M>
  using Inputs = SubsurfaceInputs<M>;

  Medium medium() const {
    Medium contents = Glass<N>::medium();
    contents.albedo = albedo;
    contents.anisotropy = anisotropy;
    return contents;
  }
};

// Parameters of a Subsurface material. `filter` of the base class stays 1.
template <class N>
struct SubsurfaceInputs : GlassInputs<N> {
  Vec3<N> log2_transmittance;  // per metre
  Vec3<N> albedo;
  N anisotropy;

  void read(MaterialParams& p);
  Subsurface<N> record() const {
    Subsurface<N> record{GlassInputs<N>::record(), albedo, anisotropy};
    record.body.log2_filter = log2_transmittance;
    return record;
  }
};

}  // namespace orrery
