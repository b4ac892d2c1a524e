#include "core/model/camera.h"

#include <algorithm>
#include <cmath>

#include "core/math/angles.h"

namespace orrery {

CameraFrame frame_at(const CameraPlacement& placement, const Camera& camera, const Orbit& orbit) {
  const Vec3d pole = safe_normalize(placement.up);
  const Vec3d offset = placement.eye - placement.look_at;
  const double own_distance = length(offset);
  // Direction from look_at to the eye of the scene's camera, split into the parts along and across the pole.
  const Vec3d direction = safe_normalize(offset);
  const double own_sine = dot(direction, pole);
  const Vec3d across = direction - pole * own_sine;
  const double own_cosine = length(across);
  const Vec3d own_out = across / own_cosine, own_right = cross(pole, own_out);

  const SineCosine turn = sine_cosine_degrees(orbit.azimuth_degrees);
  const Vec3d out = own_out * turn.cosine + own_right * turn.sine;
  const Vec3d right = own_right * turn.cosine - own_out * turn.sine;
  const SineCosine lift = sine_cosine_degrees(std::clamp(orbit.elevation_degrees, -180.0, 180.0));
  double cosine = own_cosine * lift.cosine - own_sine * lift.sine;
  double sine = own_sine * lift.cosine + own_cosine * lift.sine;
  if (cosine < 0 || std::abs(orbit.elevation_degrees) >= 180) {
    cosine = 0;
    sine = orbit.elevation_degrees > 0 ? 1 : -1;
  }

  CameraFrame frame;
  frame.back = out * cosine + pole * sine;
  frame.up = pole * cosine - out * sine;
  frame.right = right;
  frame.distance = own_distance * orbit.distance;
  frame.aperture_radius = placement.aperture_radius;
  frame.blades = placement.blades;
  frame.focus_distance = placement.focus_distance.value_or(frame.distance);
  frame.eye = placement.look_at + frame.back * frame.distance;
  const bool own_place = turn.sine == 0 && turn.cosine == 1 && lift.sine == 0 && orbit.distance == 1;
  if (own_place) frame.eye = placement.eye;
  frame.eye = frame.eye + orbit.pan;
  frame.half_extent = camera.half_extent(orbit.distance);
  return frame;
}

}  // namespace orrery
