#include "core/atmospheres/depth_cue.h"

#include "core/params/params.h"

namespace orrery {

template <class N>
DepthCue<double> DepthCue<N>::read(Params& p) {
  constexpr Range kDepth = {.min = 0, .max = kMaxLength}, kScale = {.min = 0, .max = 1};
  const Vec3d color = p.color("color", "Radiance that objects fade to.", Vec3d(0));
  const double front = p.number("front", "Depth of the front plane, in metres along the view axis.", kDepth);
  const double back = p.number("back", "Depth of the back plane, in metres along the view axis.", kDepth);
  if (!(front < back))
    p.fail("back", "must be greater than front, " + number_text(front) + " (got " + number_text(back) + ")");
  return {color, front, back,
          p.number("front_scale", "Share of the radiance that remains up to the front plane.", kScale, 1.0),
          p.number("back_scale", "Share of the radiance that remains beyond the back plane.", kScale, 0.0)};
}

// Depths have an error of a few epsilon times the depth. The slope of the ramp multiplies this error.
template <class N>
RoundingLimit DepthCue<N>::rounding() const {
  constexpr double kMaxError = 2e-4, kRoundings = 8;
  const double fade = std::abs(front_scale - back_scale);
  if (!(fade > 0)) return {};
  return {kMaxError * (back - front) / (kRoundings * back * fade),
          "the planes of the depth cue are only " + number_text(back - front) + " m apart"};
}

AtmosphereType depth_cue_type() {
  return {DepthCue<double>::kName, "Depth cueing: fades objects to a colour with their depth in the image.",
          read_atmosphere<DepthCue>};
}

}  // namespace orrery
