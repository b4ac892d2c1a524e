#pragma once

#include <limits>
#include <numbers>

#include "core/lights/arrival.h"
#include "core/math/hemisphere.h"
#include "core/model/light.h"

namespace orrery {

// Infinitely distant light, parallel or from a disc in the sky. A white Lambert surface that faces the light
// has radiance `intensity`.
template <class N>
struct Directional {
  Vec3<N> from, intensity;
  N height;  // 1 - cosine of the disc's half angle; 0: parallel

  static constexpr LightTraits kTraits = {.delta = false, .parallel = true};
  static Directional<double> read(Params& p);

  LightBounds bounds() const { return {.strength = max_component(intensity), .parallel = true}; }

  // Returns LightBatch::incident for draw(). It is at least the value for arrive().
  Vec3d max_incident(double) const { return intensity * (2 / (2 - height)); }

  Vec3d max_radiance_at_infinity() const {
    return height > 0 ? intensity * (1 / (height * (2 - height))) : Vec3d(0);
  }

  Arrival<N> arrive(const Vec3<N>&) const { return {from, N(std::numeric_limits<T>::infinity()), intensity}; }

  // Returns whether the light is a disc. Discs narrower than the rounding of directions count as parallel
  // light.
  MaskOf<N> extended() const {
    constexpr T kRounded = std::numeric_limits<T>::epsilon();
    return height > N(kRounded * kRounded);
  }
  // Samples the disc uniformly by solid angle.
  LightSample<N> draw(const Vec3<N>&, const N& u, const N& v) const {
    using std::sqrt;
    const N h = u * height, across = sqrt(h * (T(2) - h));
    const auto [sine, cosine] = sine_cosine_turns(v);
    const Tangents<N> basis = tangents_of(from);
    const Vec3<N> direction =
        basis.first * (across * cosine) + basis.second * (across * sine) + from * (T(1) - h);
    return {{direction, N(std::numeric_limits<T>::infinity()), intensity * (T(2) / (T(2) - height))},
            density()};
  }
  // Returns the radiance of the disc and the density of draw(). Both are 0 outside the disc and for parallel
  // light.
  DistantRadiance<N> beyond(const Vec3<N>& direction) const {
    const Vec3<N> chord = direction - from;
    const auto inside = dot(chord, chord) <= T(2) * height && extended();
    const N sine2 = height * (T(2) - height);
    return {select(inside, intensity * (T(1) / sine2), Vec3<N>(N(T(0)))), select(inside, density(), N(T(0)))};
  }

 private:
  using T = ScalarOf<N>;
  N density() const { return T(0.5 / std::numbers::pi) / height; }
};

}  // namespace orrery
