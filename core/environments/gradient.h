#pragma once

#include "core/model/environment.h"

namespace orrery {

// Sky whose radiance changes linearly with the direction's y from horizon to zenith, over ground of constant
// radiance. Up is +y.
template <class N>
struct Gradient {
  Vec3<N> zenith, horizon, ground;

  static Gradient<double> read(Params& p);

  Vec3<N> most() const { return largest(largest(zenith, horizon), ground); }
  Vec3<N> least() const { return -largest(largest(-zenith, -horizon), -ground); }
  Vec3<N> radiance(const Vec3<N>& direction) const {
    const N height = max_first(N(ScalarOf<N>(0)), direction.y);
    return select(direction.y >= N(ScalarOf<N>(0)), horizon + (zenith - horizon) * height, ground);
  }
};

}  // namespace orrery
