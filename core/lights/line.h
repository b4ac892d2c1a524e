#pragma once

#include <numbers>

#include "core/lights/arrival.h"
#include "core/math/elementary.h"
#include "core/model/light.h"

namespace orrery {

// Infinitely thin line light. The intensity is uniform along the line and in all directions. Rays cannot hit
// the line.
template <class N>
struct Line {
  Vec3<N> start, along;  // along: unit
  N extent;              // metres
  Vec3<N> intensity;     // watts per steradian and per metre of the line

  static constexpr LightTraits kTraits = {.delta = true};
  static Line<double> read(Params& p);

  Vec3<N> whole_intensity() const { return intensity * extent; }

  // Treats the whole power as emitted at the midpoint. The estimate is bounded by its value at half the
  // line's length from the midpoint.
  LightBounds bounds() const {
    return {.centre = start + along * (extent / 2),
            .radius = extent / 2,
            .strength = max_component(intensity) * (4 / (kPi * extent)),
            .attenuation = {1, 0, 4 / (extent * extent)}};
  }

  Vec3d max_incident(double distance) const {
    const auto of = [&](double watts) {
      return watts > 0 ? watts * extent / (kPi * distance * distance) : 0;
    };
    return {of(intensity.x), of(intensity.y), of(intensity.z)};
  }

  // Treats the whole power as emitted at the midpoint.
  Arrival<N> arrive(const Vec3<N>& position) const {
    const Vec3<N> line = start + along * (extent * T(0.5)) - position;
    const N distance2 = dot(line, line), distance = length(line);
    const auto apart = distance > N(T(0));
    const N reciprocal = select(apart, N(T(1) / distance), N(T(0)));
    return {line * reciprocal, select(apart, distance, N(T(-1))),
            intensity * select(apart, N(extent / (kPi * distance2)), N(T(0)))};
  }

  MaskOf<N> extended() const { return extent > N(T(0)); }
  // Samples the line uniformly in the angle that it subtends at `position`, so the squared distance cancels.
  // h is the distance of `position` from the infinite line. s and t are coordinates of the start and of the
  // sample along the line, measured from the point nearest to `position`. At an angle d from the start, t = h
  // (s cos d + h sin d) / (h cos d - s sin d).
  LightSample<N> draw(const Vec3<N>& position, const N& u, const N&) const {
    const Vec3<N> toward_start = start - position;
    const N s = dot(toward_start, along), end = s + extent;
    const N h = length(toward_start - along * s);
    const N turns = direction_turns(N(h * h + s * end), N(h * extent));
    const auto [sine, cosine] = sine_cosine_turns(N(u * turns));
    const N t = h * (s * cosine + h * sine) / (h * cosine - s * sine);
    const auto apart = h > N(T(0));
    const N met = min_first(end, max_first(s, select(apart, t, s)));
    const Vec3<N> line = toward_start + along * (met - s);
    const N distance = length(line);
    const auto seen = apart && distance > N(T(0));
    return {{line * select(seen, N(T(1) / distance), N(T(0))), select(seen, distance, N(T(-1))),
             intensity * select(seen, N(T(2) * turns / h), N(T(0)))},
            N(T(0))};
  }

 private:
  using T = ScalarOf<N>;
  static constexpr T kPi = std::numbers::pi_v<T>;
};

}  // namespace orrery
