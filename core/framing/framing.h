#pragma once

#include <span>

#include "core/math/vec3.h"

namespace orrery {

// Right-handed axes in which a camera turns around an object. Azimuth 0 looks at the front of the object.
struct StudioAxes {
  Vec3d right, up, front;  // unit vectors, in scene coordinates

  // Returns the axes with this direction up: one of +x, -x, +y, -y, +z and -z. The front of y-up objects
  // faces +z, as in glTF, and that of z-up objects -y.
  static StudioAxes with_up(const Vec3d& up);
};

// Direction from an object to the camera, in degrees.
struct ViewDirection {
  double azimuth = 0;    // from the front toward the right, anticlockwise as seen from above
  double elevation = 0;  // -90 to 90
};

// Content of the image: the object as seen, or the object from every azimuth.
enum class Fit { view, turn };

struct FramingRequest {
  StudioAxes axes;
  ViewDirection from = {};
  double aspect = 1;       // width / height of the image
  double fov_degrees = 0;  // vertical field of view; 0: orthographic
  double margin = 0.05;    // part of the image on each side that stays empty, 0 to 0.45
  Fit fit = Fit::view;
};

struct Framing {
  Vec3d eye, look_at, up;
  double height = 0;  // height of an orthographic view in metres
};

// Returns the nearest camera that sees all points within the margins, and that is a tenth of their size away
// from the nearest one. With Fit::view, the margins left and right, or above and below, are exact unless that
// distance is; orthographic views are centred. With Fit::turn, the camera looks at
// the centre of the points' bounds and sees all points from every azimuth. Points at one place get a height
// and a distance of 1 m. REQUIRES: at least one point.
Framing frame_points(std::span<const Vec3d> points, const FramingRequest& request);

}  // namespace orrery
