#pragma once

#include "core/atmospheres/formula.h"

namespace orrery {

// Depth cueing: blends the radiance of distant objects with a colour. The share of the radiance is
// `front_scale` up to the front plane and `back_scale` beyond the back plane, and linear in the depth between
// them (PHIGS, ISO 9592; its planes are Zf and Zb, with the scale factors Sf and Sb).
template <class N>
struct DepthCue {
  static constexpr const char* kName = "depth_cue";
  static constexpr bool kAlongAllRays = false, kHidesBackground = false;

  Vec3<N> color;
  N front, back;  // depths of the planes, metres along the view axis; front < back
  N front_scale, back_scale;

  static DepthCue<double> read(Params& p);
  RoundingLimit rounding() const;

  [[gnu::always_inline]] N share(const N&, const N& depth) const {
    const N linear = back_scale + (depth - back) * ((front_scale - back_scale) / (front - back));
    return select(depth <= front, front_scale, select(depth >= back, back_scale, linear));
  }
};

}  // namespace orrery
